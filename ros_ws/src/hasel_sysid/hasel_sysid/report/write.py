# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Write the report: one HTML file that needs no network."""

import json
import string
import zlib
from collections.abc import Sequence
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import plotly.graph_objects as go
from hasel_sim.parameter import value_with_error
from jinja2 import Environment, FunctionLoader, StrictUndefined
from plotly.offline import get_plotlyjs, get_plotlyjs_version

from hasel_sysid.report.content import ReportContent, provenance
from hasel_sysid.report.figures import (
    component_map_figure,
    conditions_figures,
    phase_map_figure,
    ranking_figure,
    residual_tests_figures,
    shapes_figure,
    waterfall_figures,
)
from hasel_sysid.report.overlay import model_colours, overlay_figure
from hasel_sysid.report.style import model_colour
from hasel_sysid.report.wording import percent

ALPHABET = f"{string.digits}{string.ascii_uppercase}{string.ascii_lowercase}!#$%/()*+-;,=.?@^_`{{|}}~"
"""That of RFC 1924 with / , . in the place of & < >."""
REPORT_FILE = "report.html"
Figure: TypeAlias = go.Figure | dict[str, Any]
"""Plotly's, or what plotly.js takes."""


def packed(text: str) -> str:
    """A third of the text's size or less, without any of < > & and quotes."""
    raw = zlib.compress(text.encode(), 6)
    counted = len(raw).to_bytes(4, "big") + raw
    words = np.frombuffer(counted + bytes(-len(counted) % 4), dtype=">u4").astype(np.uint32)
    places = np.array([85**4, 85**3, 85**2, 85, 1], dtype=np.uint32)
    digits = words[:, None] // places % 85
    return np.frombuffer(ALPHABET.encode(), dtype=np.uint8)[digits].tobytes().decode("ascii")


def write_report(content: ReportContent, folder: Path) -> Path:
    """Write `report.html` into a folder, made if need be, and return its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / REPORT_FILE
    path.write_text(
        render(content if content.made else replace(content, made=provenance())), encoding="utf-8"
    )
    return path


def render(content: ReportContent) -> str:
    """The whole page, plotly's code and the figures packed into it."""
    environment = Environment(
        loader=FunctionLoader(_template),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"percent": percent}
    environment.globals |= {
        "value_with_error": value_with_error,
        "model_colours": model_colours,
        "model_colour": model_colour,
    }
    figures = {name: _plain(each) for name, each in _figures(content).items() if each}
    single = {f"{name}{n}": figure for name, each in figures.items() for n, figure in enumerate(each)}
    return environment.get_template("report.html").render(
        content=content,
        figures={name: _places(name, each) for name, each in figures.items()},
        plotly_code=packed(get_plotlyjs()) if figures else "",
        plotly_version=get_plotlyjs_version(),
        packed_figures=packed(json.dumps(single, separators=(",", ":"))),
        unpack=_template("unpack.js"),
        style=_template("style.css"),
    )


def _figures(content: ReportContent) -> dict[str, list[Figure]]:
    """Figures of every place of the page; those of one place stand side by side where there is room."""
    figures: dict[str, list[Figure]] = {}
    if content.stages:
        figures["waterfall"] = waterfall_figures(content.stages, content.noise_floor)
    for number, run in enumerate(content.runs):
        figures[f"run_{number}_"] = [overlay_figure(run)]
    if content.shapes is not None:
        figures["shapes"] = [shapes_figure(content.shapes)]
    if content.ranking:
        figures["ranking"] = [ranking_figure(content.ranking)]
    if content.comparisons:
        detail = content.detail
        several_driven = sum(run.series.level > 0 for run in detail.runs) > 1
        figures["conditions"] = conditions_figures(content.comparisons) if several_driven else []
        figures["phase"] = list(filter(None, [phase_map_figure(detail.runs)]))
        figures["components"] = list(filter(None, [component_map_figure(detail.runs)]))
        figures["residual_tests"] = residual_tests_figures(detail.runs)
    return figures


def _places(name: str, figures: Sequence[dict[str, Any]]) -> str:
    each = [
        f'<div class="figure" data-figure="{name}{n}" style="height:{figure["layout"]["height"]}px"></div>'
        for n, figure in enumerate(figures)
    ]
    return each[0] if len(each) == 1 else f'<div class="pair">{"".join(each)}</div>'


def _plain(value: Any) -> Any:
    """Figures as plotly.js takes them, numbers to six digits."""
    if isinstance(value, go.Figure):  # whose own to_plotly_json packs numbers that nobody rounded
        value = {"data": value.data, "layout": value.layout}
    elif hasattr(value, "to_plotly_json"):
        value = value.to_plotly_json()
    if isinstance(value, dict):
        return {key: _plain(each) for key, each in value.items() if key != "template"}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [_plain(each) for each in value]
    if isinstance(value, (float, np.floating)):
        return float(f"{value:.6g}") if np.isfinite(value) else None
    return value.item() if isinstance(value, np.generic) else value


def _template(name: str) -> str:
    return (resources.files("hasel_sysid.report") / "templates" / name).read_text(encoding="utf-8")
