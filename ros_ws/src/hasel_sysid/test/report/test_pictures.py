# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Pictures for a README."""

import matplotlib.image
import numpy as np
from hasel_sysid.report.content import ReportContent, RunOverlay, StageRow
from hasel_sysid.report.pictures import overlay_picture, stages_picture, vector_figures, waterfall_picture

STAGES = (
    StageRow("start", 0.08, 0.09),
    StageRow("fit", 0.03, 0.05),
    StageRow("+ quadratic_drag", 0.003, 0.004),
)


def _colours(path) -> set[int]:
    """All colours of a picture as 0xRRGGBB."""
    red, green, blue = np.moveaxis((matplotlib.image.imread(path)[..., :3] * 255).round().astype(int), 2, 0)
    return set(np.unique(red * 0x10000 + green * 0x100 + blue).tolist())


def test_waterfall_shows_fitted_and_unseen(tmp_path):
    """Totals of both kinds of runs and the drops are drawn in their colours."""
    path = waterfall_picture(STAGES, 0.0024, tmp_path / "new" / "waterfall.png")
    assert {0x2E86AB, 0xEDAE49, 0x8FC3A3} <= _colours(path)


def test_without_unseen_runs_there_is_one_panel(tmp_path):
    """Without unseen runs nothing is drawn for them."""
    stages = [StageRow(stage.label, stage.error) for stage in STAGES]
    assert 0xEDAE49 not in _colours(waterfall_picture(stages, None, tmp_path / "w.png"))
    assert 0xEDAE49 not in _colours(stages_picture(stages, None, tmp_path / "s.png"))
    assert 0xEDAE49 in _colours(stages_picture(STAGES, 0.0024, tmp_path / "t.png"))


def test_overlay_shows_the_model(tmp_path):
    """The model's line is drawn over the measured points."""
    time = np.linspace(0, 1, 100)
    run = RunOverlay("run", time, np.sin(9 * time), {"model": np.sin(9 * time)})
    assert 0xD1495B in _colours(overlay_picture([run], tmp_path / "o.png"))


def test_vector_figures_lie_beside_the_report(tmp_path):
    """Every run, and the error by stage, as SVG whose text is text."""
    time = np.linspace(0, 1, 100)
    runs = [RunOverlay(f"run_{number}", time, time, {"model": time}) for number in range(5)]
    written = vector_figures(ReportContent("title", runs=runs, stages=STAGES, noise_floor=0.002), tmp_path)
    assert [path.name for path in written] == ["runs.svg", "waterfall.svg", "error_by_stage.svg"]
    for number in range(5):
        assert f">run_{number}</text>" in written[0].read_text()
