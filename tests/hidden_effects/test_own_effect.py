# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""An effect of one's own, which no catalogue lists: recordings of a truth that has it, and `improve --add`."""

import json
from pathlib import Path

import hasel_benchmark
import numpy as np
import pytest
from hasel_bringup.hidden_truth.plan import FITTED, UNSEEN
from hasel_bringup.hidden_truth.truth import NUMERICS, draw_muscles, truth_model
from hasel_recording import Recording, write_recording
from hasel_sim.parallel import simulate_all
from hasel_sysid.command_line.improve import main

OWN = Path(hasel_benchmark.__file__).parent / "bench_hidden" / "unlisted_effects.py"
COEFFICIENT = 600.0


@pytest.fixture
def recordings(tmp_path, pool) -> tuple[list[str], list[str]]:
    """Nine runs to fit and three unseen ones, with white noise, of muscles that the model does not know."""
    generator = np.random.default_rng(7)
    hidden = {f"{OWN}:CubicDrag": {"coefficient": COEFFICIENT}}
    truth = truth_model(NUMERICS["near"], draw_muscles(generator), hidden)
    boxes = (*FITTED, *UNSEEN)
    runs = [box.run(switch_on_frames=True) for box in boxes]
    paths = []
    for run, seen in zip(runs, simulate_all(pool, truth, runs), strict=True):
        angle = seen.sin_theta + 0.003 * generator.normal(size=len(run.time)) + 0.01 * generator.normal()
        recording = Recording(run.name, run.time, angle, drive_signal=run.schedule.at(run.time))
        write_recording(recording, tmp_path / f"{run.name}.csv")
        paths.append(str(tmp_path / f"{run.name}.csv"))
    return paths[: len(FITTED)], paths[len(FITTED) :]


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_it_is_named_beside_the_catalogue_with_its_size(recordings, tmp_path):
    """First, explained, its size within 2 %, and the unseen runs predicted to the noise."""
    fitted, unseen = recordings
    result, output = tmp_path / "found.json", tmp_path / "answer"
    arguments = [*fitted, "--validate", *unseen, "--add", f"{OWN}:CubicDrag"]
    assert main([*arguments, "--jobs", "2", "--output", str(output), "--json", str(result)]) == 0
    found = json.loads(result.read_text())
    assert found["verdict"]["missing"] == ["cubic_drag"]
    assert found["verdict"]["status"] == "explained"
    coefficient = found["stages"][-1]["parameters"]["cubic_drag.coefficient"]["value"]
    assert coefficient == pytest.approx(COEFFICIENT, rel=0.02)
    assert found["stages"][-1]["mae_validation"] < 1.1 * 0.003 * np.sqrt(2 / np.pi)
