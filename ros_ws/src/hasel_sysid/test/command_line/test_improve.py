"""The commands `improve` and `diagnose` from end to end, on a coarse model with a hidden effect."""

import json
from pathlib import Path

import numpy as np
import pytest
from hasel_recording import Recording, write_recording
from hasel_sim.drive.voltage import VoltageSchedule
from hasel_sim.model import load_model, save_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from hasel_sysid.command_line import improve

COARSE = {"mesh_density": 0.5, "quadrature_order": 2, "steps_per_second": 120.0}
VALUES = {"amplitude_3500": 0.027, "amplitude_5500": 0.062, "slope": 0.3, "quadratic_drag.coefficient": 0.25}


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Recordings of a coarse swimmer with quadratic drag, and the model without."""
    folder = tmp_path_factory.mktemp("hidden")
    coarse = load_model("swimmer").with_numerics(**COARSE)
    save_model(coarse, folder / "coarse.yaml")
    truth = coarse.with_levels(np.array([3500.0, 5500.0])).with_effects("quadratic_drag").with_values(VALUES)
    conditions = ((3500.0, 1.0), (3500.0, 2.0), (5500.0, 1.0), (5500.0, 2.0), (4500.0, 1.5))
    for seed, (voltage, frequency) in enumerate(conditions):
        frames = np.arange(0, 2 / frequency, 1 / 120)
        side = np.mod(frames * frequency, 1) < 0.5
        drive = voltage * np.column_stack([side, ~side])
        angle = simulate(truth, Run("r", frames, VoltageSchedule(frames, drive))).sin_theta
        noise = 0.002 * np.random.default_rng(seed).normal(size=len(frames))
        name = f"{voltage:.0f}V_{frequency:g}Hz"
        write_recording(Recording(name, frames, angle + noise, drive), folder / f"{name}.csv")
    return folder


def test_improve_adds_the_hidden_effect(folder, tmp_path, capsys):
    """The drag is named, added with its value, and the error falls to the noise on fitted and unseen runs."""
    fitted = sorted(str(path) for path in folder.glob("[35]*V*.csv"))
    arguments = [
        *fitted,
        "--validate",
        str(folder / "4500V_1.5Hz.csv"),
        "--model",
        str(folder / "coarse.yaml"),
    ]
    arguments += ["--effects", "quadratic_drag,muscle_asymmetry", "--jobs", "1", "--output", str(tmp_path)]
    assert improve.main([*arguments, "--json", str(tmp_path / "i.json")]) == 0
    content = json.loads((tmp_path / "i.json").read_text())
    assert content["verdict"]["status"] == "explained"
    assert content["verdict"]["missing"] == ["quadratic_drag"]
    first, last = content["stages"][0], content["stages"][-1]
    drag = last["parameters"]["quadratic_drag.coefficient"]
    assert abs(drag["value"] - 0.25) < 4 * drag["std"]
    assert last["mae_fit"] < 0.002 < 0.1 * first["mae_fit"]
    assert last["mae_validation"] < 0.002
    assert content["where_it_fails"]
    assert content["start"]["mae_fit"] > first["mae_fit"]
    assert "Missing: quadratic_drag" in (tmp_path / "report.html").read_text(encoding="utf-8")
    assert load_model(tmp_path / "improved_model.yaml").effects[0].id == "quadratic_drag"
    lines = [json.loads(line) for line in (tmp_path / "ledger.jsonl").read_text().splitlines()]
    assert [line["effects"] for line in lines] == [[], ["quadratic_drag"]]
    for line in lines:
        load_model(tmp_path / line["model"])
    assert {"waterfall.png", "error_by_stage.png"} <= {path.name for path in tmp_path.iterdir()}
    assert "quadratic_drag is missing" in capsys.readouterr().out
