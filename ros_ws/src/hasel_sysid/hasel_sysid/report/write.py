"""Write the report: one HTML file that needs no network."""

from importlib import resources
from pathlib import Path

import plotly.graph_objects as go
from jinja2 import Environment, FunctionLoader, StrictUndefined
from plotly.offline import get_plotlyjs

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.report.content import ReportContent
from hasel_sysid.report.figures.component_map import component_map_figure
from hasel_sysid.report.figures.conditions import conditions_figure
from hasel_sysid.report.figures.overlay import overlay_figure
from hasel_sysid.report.figures.phase_map import phase_map_figure
from hasel_sysid.report.figures.ranking import ranking_figure
from hasel_sysid.report.figures.residual_tests import residual_tests_figure
from hasel_sysid.report.figures.waterfall import waterfall_figure
from hasel_sysid.report.numbers import percent, value_with_error

REPORT_FILE = "report.html"
_CONFIG = {
    "displaylogo": False,
    "displayModeBar": "hover",
    "responsive": True,
    "modeBarButtonsToRemove": ["select2d", "lasso2d"],
}


def write_report(content: ReportContent, folder: Path) -> Path:
    """Write `report.html` into a folder, made if need be, and return its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / REPORT_FILE
    path.write_text(render(content), encoding="utf-8")
    return path


def render(content: ReportContent) -> str:
    """The whole page, plotly's code included once."""
    environment = Environment(
        loader=FunctionLoader(_template),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"percent": percent}
    environment.globals |= {"value_with_error": value_with_error}
    return environment.get_template("report.html").render(
        content=content,
        figures={name: _html(figure) for name, figure in _figures(content).items() if figure is not None},
        plotly_code=get_plotlyjs(),
        style=_template("style.css"),
    )


def _figures(content: ReportContent) -> dict[str, go.Figure | None]:
    figures: dict[str, go.Figure | None] = {}
    if content.stages:
        figures["waterfall"] = waterfall_figure(content.stages, content.noise_floor)
    if content.runs:
        figures["overlay"] = overlay_figure(content.runs)
    if content.ranking:
        figures["ranking"] = ranking_figure(content.ranking)
    if content.comparisons:
        first = content.comparisons[0]
        figures["conditions"] = conditions_figure(content.comparisons) if _driven(first) else None
        figures["phase"] = phase_map_figure(first.runs)
        figures["components"] = component_map_figure(first.runs)
        figures["residual_tests"] = residual_tests_figure(first.runs)
    return figures


def _driven(comparison: Comparison) -> bool:
    """Whether there are several runs with a drive, so that conditions can be compared."""
    return sum(run.series.level > 0 for run in comparison.runs) > 1


def _html(figure: go.Figure) -> str:
    return figure.to_html(full_html=False, include_plotlyjs=False, include_mathjax=False, config=_CONFIG)


def _template(name: str) -> str:
    return (resources.files("hasel_sysid.report") / "templates" / name).read_text(encoding="utf-8")
