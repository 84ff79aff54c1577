"""The report is one page that needs nothing else."""

import re
from html.parser import HTMLParser

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sim.run import Simulation
from hasel_sysid.compare.compare import comparison_of
from hasel_sysid.dataset import experiment
from hasel_sysid.report.content import NextRun, ParameterRow, RankedRow, ReportContent, RunOverlay, Stage
from hasel_sysid.report.figures.waterfall import waterfall_figure
from hasel_sysid.report.from_results import comparison_content
from hasel_sysid.report.write import render, write_report

STAGES = (Stage("start", 0.08, 0.09), Stage("fit", 0.03, 0.05), Stage("+ quadratic_drag", 0.003, 0.004))


class _Page(HTMLParser):
    """Collects headings, cells, what the page loads, and checks that tags close."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.headings, self.cells, self.loads, self._inside = [], [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self._inside.append(tag)
        self.loads += [v for k, v in attributes if k in ("src", "href")]

    def handle_endtag(self, tag):
        while self._inside and self._inside.pop() != tag:
            pass

    def handle_data(self, data):
        if self._inside and data.strip():
            if self._inside[-1] in ("h1", "h2", "h3"):
                self.headings.append(data.strip())
            if "td" in self._inside:
                self.cells.append(" ".join(data.split()))


def _comparison(made_recording, angle, label="model"):
    experiments = [experiment(made_recording(name=f"<run {n}>", seed=n)) for n in range(2)]
    simulations = [
        Simulation(
            e.run,
            0.9 * angle(e.run.time, 2.0),
            (),
            np.zeros((len(e.run.time), 0)),
            np.zeros((len(e.run.time), 3, 2)),
            np.zeros((len(e.run.time), 2)),
        )
        for e in experiments
    ]
    model = (
        load_model("swimmer").with_levels(np.array([4500.0])).with_values({"slope": 0.26}, {"slope": 0.01})
    )
    return comparison_of(model, experiments[:1], simulations, experiments[1:], label)


def test_page_loads_nothing(made_recording, angle, tmp_path):
    """The page has plotly's code once, loads no file and no address, and shows runs, errors and parameters."""
    path = write_report(comparison_content([_comparison(made_recording, angle)]), tmp_path / "new")
    text = path.read_text(encoding="utf-8")
    page = _Page(text)
    assert page.loads == []
    assert len(re.findall(r"plotly\.js v\d", text)) == 1
    assert page.headings[0] == "model against 2 recordings"
    for heading in ("Measured against simulated", "Where it fails", "Error of every run", "Parameters"):
        assert heading in page.headings
    assert "0.260 ± 0.010 1/s" in page.cells
    assert text.count('class="plotly-graph-div"') == 5


def test_names_are_escaped(made_recording, angle):
    """A run called <run 0> is text, not a tag."""
    text = render(comparison_content([_comparison(made_recording, angle)]))
    assert "&lt;run 0&gt;" in text
    assert "<run 0>" not in re.sub(r"<script.*?</script>", "", text, flags=re.S)


def test_two_models_stand_side_by_side(made_recording, angle):
    """Both models' errors are columns, and both are in the plot's legend."""
    models = [_comparison(made_recording, angle, label) for label in ("one", "two")]
    text = render(comparison_content(models))
    assert {"one", "two"} <= set(re.findall(r'<th class="number">(\w+)</th>', text))
    assert '"name":"two"' in text


def test_sections_of_an_improvement():
    """Stages, ranking, groups, what remains and the next run are shown, and only those."""
    content = ReportContent(
        title="Missing: quadratic_drag",
        verdict="What is left is noise.",
        good=True,
        stages=STAGES,
        noise_floor=0.0024,
        ranking=[
            RankedRow(
                "quadratic_drag", "missing", 0.93, 0.98, [ParameterRow("coefficient", 0.25, 0.004, "1")]
            ),
            RankedRow("tether", "cannot be seen", 0.0, 0.01),
        ],
        groups=[("quadratic_drag", "linear_drag")],
        remains=["Two per cent are left."],
        next_runs=[NextRun("Triangle of 5000 V at 0.5 Hz.", 8.25, ("quadratic_drag", "linear_drag"))],
    )
    page = _Page(render(content))
    assert page.headings == [
        "Missing: quadratic_drag",
        "The error, stage by stage",
        "Which effect is missing",
        "These recordings cannot tell apart",
        "What remains",
        "What to measure next",
    ]
    assert {"93 %", "98 %", "coefficient = 0.2500 ± 0.0040", "0.00400", "noise floor"} <= set(page.cells)


def test_empty_content_is_a_page():
    """A title alone makes a valid page without figures."""
    text = render(ReportContent(title="Nothing yet"))
    assert _Page(text).headings == ["Nothing yet"]
    assert 'class="plotly-graph-div"' not in text


def test_waterfall_adds_up():
    """The bars start at the first error, change by the differences and end at what is left, on both kinds of runs."""
    figure = waterfall_figure(STAGES, 0.0024)
    assert [trace.name for trace in figure.data] == ["fitted runs", "unseen runs"]
    for trace, errors in zip(figure.data, ([0.08, 0.03, 0.003], [0.09, 0.05, 0.004]), strict=True):
        assert sum(trace.y[:-1]) == pytest.approx(errors[-1])
        assert trace.y[0] == errors[0]
        assert trace.measure == ("absolute", "relative", "relative", "total")
    assert figure.layout.shapes[0].y0 == 0.0024


def test_overlay_keeps_every_run():
    """Each run has its measured points and each model's line; unseen ones say so."""
    from hasel_sysid.report.figures.overlay import overlay_figure

    time = np.arange(0, 1, 1 / 120)
    runs = [
        RunOverlay(f"r{n}", time, np.sin(time), {"a": np.cos(time), "b": 0 * time}, n == 3, "4500 V", 2.0)
        for n in range(4)
    ]
    figure = overlay_figure(runs)
    assert len(figure.data) == 12
    assert figure.layout.annotations[3].text == "4500 V, 2 Hz · unseen"
