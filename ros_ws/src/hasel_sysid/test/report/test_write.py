# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The report is one page that needs nothing else."""

import base64
import json
import re
import zlib
from html.parser import HTMLParser

import numpy as np
import plotly.graph_objects as go
import pytest
from hasel_sim.model import load_model
from hasel_sim.run import Simulation
from hasel_sysid.comparison import comparison_of
from hasel_sysid.experiment import experiment_of
from hasel_sysid.report.content import NextRun, ParameterRow, RankedRow, ReportContent, RunOverlay, StageRow
from hasel_sysid.report.figures import waterfall_figures
from hasel_sysid.report.from_results import comparison_content
from hasel_sysid.report.overlay import driven_stretches, overlay_figure
from hasel_sysid.report.style import CHANNELS
from hasel_sysid.report.write import packed, render, write_report
from plotly.offline import get_plotlyjs


def unpacked(page: str, name: str) -> str:
    """What a packed script of the page holds."""
    text = re.search(rf'id="{name}">([^<]*)<', page).group(1)
    raw = base64.b85decode(text.translate(str.maketrans(",./", "<>&")))
    return zlib.decompress(raw[4 : 4 + int.from_bytes(raw[:4], "big")]).decode()


STAGES = (
    StageRow("start", 0.08, 0.09),
    StageRow("fit", 0.03, 0.05),
    StageRow("+ quadratic_drag", 0.003, 0.004),
)


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
    experiments = [experiment_of(made_recording(name=f"<run {n}>", seed=n)) for n in range(2)]
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
    assert unpacked(text, "plotly") == get_plotlyjs()
    assert len(text) < 2_000_000
    assert page.headings[0] == "model against 2 recordings"
    for heading in ("Measured against simulated", "Where it fails", "Error of every run", "Parameters"):
        assert heading in page.headings
    assert "0.260 ± 0.010 1/s" in page.cells
    figures = json.loads(unpacked(text, "figures"))
    assert set(figures) == set(re.findall(r'data-figure="(\w+)"', text))
    assert {"run_0_0", "run_1_0", "shapes0", "phase0", "components0", "residual_tests0"} <= set(figures)
    for word in ("How this was made", "Recordings", "Versions", "hasel_sysid"):
        assert word in text


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
    assert '"name":"two"' in unpacked(text, "figures")


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
    assert 'class="figure"' not in text


def test_waterfall_adds_up():
    """The bars start at the first error, change by the differences and end at what is left, on both kinds of runs."""
    figures = waterfall_figures(STAGES, 0.0024)
    assert [figure.data[0].name for figure in figures] == ["fitted runs", "unseen runs"]
    for figure, errors in zip(figures, ([0.08, 0.03, 0.003], [0.09, 0.05, 0.004]), strict=True):
        (trace,) = figure.data
        assert sum(trace.y[:-1]) == pytest.approx(errors[-1])
        assert trace.y[0] == errors[0]
        assert trace.measure == ("absolute", "relative", "relative", "total")
        assert figure.layout.shapes[0].y0 == 0.0024


def test_what_must_be_known_comes_first(made_recording, angle):
    """Before any number."""
    text = render(comparison_content([_comparison(made_recording, angle)], ["it was never fitted", ""]))
    assert text.index("It was never fitted.") < text.index('class="numbers"')


def test_the_last_stage_is_shown_in_detail(made_recording, angle):
    """What is left is of the model with all that was added, by name."""
    stages = [_comparison(made_recording, angle, label) for label in ("fitted", "fitted + drag")]
    text = render(comparison_content(stages, detailed=-1))
    for heading in ("What is left, by part of the cycle (fitted + drag)", "command (fitted + drag)"):
        assert heading in text


def test_a_run_shows_residuals_before_and_after_and_the_angle_beside_its_sine():
    """Dots measured, lines of every model above and what they leave below, the drive tinted, θ on the right."""
    time = np.arange(0, 1, 1 / 120)
    driven = driven_stretches(np.array([0.0, 0.5]), np.array([[4500.0, 0.0], [0.0, 4500.0]]), 0.0, time[-1])
    assert driven == [(0.0, 0.5, 0), (0.5, time[-1], 1)]
    run = RunOverlay(
        "r", time, 0.3 * np.sin(time), {"a": 0.2 * np.sin(time), "b": 0.3 * np.sin(time)}, driven=driven
    )
    figure = overlay_figure(run)
    above = [trace for trace in figure["data"] if trace["yaxis"] == "y"]
    below = [trace for trace in figure["data"] if trace["yaxis"] == "y3"]
    assert [trace["name"] for trace in above] == ["measured", "a", "b"]
    assert [trace["name"] for trace in below] == ["a", "b"]
    assert np.array(below[0]["y"]) == pytest.approx(0.1 * np.sin(time), abs=2e-5)
    assert np.array(below[1]["y"]) == pytest.approx(0.0, abs=2e-5)
    right = figure["layout"]["yaxis2"]
    ticks = dict(zip(right["ticktext"], right["tickvals"], strict=True))
    assert ticks["10°"] == pytest.approx(np.sin(np.deg2rad(10)))
    assert {shape["fillcolor"] for shape in figure["layout"]["shapes"]} == set(CHANNELS[:2])
    assert above[2]["line"]["width"] < above[0]["marker"]["size"] / 2
    go.Figure(figure)  # raises where plotly knows a name or a value otherwise


@pytest.mark.parametrize("text", ["", "a", "<&>\"'", "θ" * 5000, "".join(map(chr, range(32, 3000)))])
def test_python_s_own_decoder_gets_it_back(text):
    """Length, deflated text and padding in base 85, the characters that mean something in HTML replaced."""
    page = packed(text)
    assert not set(page) & set("<>&\"'")
    raw = base64.b85decode(page.translate(str.maketrans("/,.", "&<>")))
    length = int.from_bytes(raw[:4], "big")
    assert zlib.decompress(raw[4 : 4 + length]).decode() == text
    assert len(raw) - 4 - length < 4
