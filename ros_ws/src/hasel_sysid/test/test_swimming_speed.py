# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Recordings of a body that swims are compared in speed too."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import Recording
from hasel_recording.csv_run import write_csv
from hasel_sim.model import load_model, save_model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.simulate import simulate
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import free_swim
from hasel_sysid.command_line.fit import main
from hasel_sysid.command_line.shown import speed_table
from hasel_sysid.comparison import compare
from hasel_sysid.experiment import experiment_of
from hasel_sysid.swimming_speed import forward_speed
from rich.console import Console

DRIVE = Boxes(5500.0, 5500.0, 2.0)


@pytest.fixture(scope="module")
def fish():
    """A coarse swimmer in oil."""
    return load_model("swimmer_in_oil").with_numerics(mesh_density=0.5, steps_per_second=120.0)


@pytest.fixture(scope="module")
def swum(fish) -> Recording:
    """Three seconds of it, filmed, with a tenth of a millimetre of noise and some lost frames."""
    run = DRIVE.run(fish, 3.0)
    simulation = simulate(fish, run)
    markers = simulation.markers + 1e-4 * np.random.default_rng(1).standard_normal(simulation.markers.shape)
    markers[40:43] = np.nan
    sin_theta = np.where(np.isfinite(markers[:, 0, 0]), simulation.sin_theta, np.nan)
    signal = run.schedule.at(run.time)
    return Recording("swum", run.time, sin_theta, signal, markers, metadata={"model": "swimmer_in_oil"})


def test_the_speed_is_that_of_the_swim(fish, swum):
    """Of the head marker over whole periods, within noise that of the centre of mass."""
    found = free_swim(fish, DRIVE.run(fish, 3.0), 2.0)
    assert forward_speed(swum.time_s, swum.markers, 0.5) == pytest.approx(found.speed, rel=0.02)


def test_a_turned_film_gives_the_same_speed(swum):
    """Forwards is from the middle marker to the head, wherever that points; backwards is negative."""
    expected = forward_speed(swum.time_s, swum.markers, 0.5)
    there = np.array([[0.6, 0.8], [-0.8, 0.6]])
    assert forward_speed(swum.time_s, swum.markers @ there, 0.5) == pytest.approx(expected)
    assert forward_speed(swum.time_s, swum.markers[::-1], 0.5) < 0
    assert forward_speed(swum.time_s[:100], swum.markers[:100], 0.5) is None


def test_models_are_compared_in_speed(fish, swum, tmp_path):
    """From a CSV file with marker columns: the true model meets the speed, one with twice the friction is slower."""
    write_csv(swum, tmp_path / "swum.csv")
    assert "head_x_m" in (tmp_path / "swum.csv").read_text()
    rough = fish.with_values({"skin_friction.along": 3.0, "skin_friction.thinning": 8.0})
    found = [compare(model, [experiment_of(swum)], SerialExecutor()) for model in (fish, rough)]
    right, wrong = (comparison.runs[0].speed for comparison in found)
    assert right.simulated == pytest.approx(right.measured, rel=0.02)
    assert wrong.measured == right.measured
    assert wrong.simulated < 0.8 * wrong.measured
    assert found[1].mean_speed_error == pytest.approx(wrong.measured - wrong.simulated)
    assert found[0].to_json()["runs"][0]["speed_m_per_s"] == right.measured
    console = Console(width=100)
    with console.capture() as shown:
        console.print(speed_table(found))
    assert "swum" in shown.get() and "mean |Δ speed|" in shown.get()


def test_a_fit_says_measured_and_simulated_speeds(fish, swum, tmp_path, capsys):
    """On the terminal, for other programs, in the sentence and in the report; before and after are told apart."""
    write_csv(swum, tmp_path / "swum.csv")
    draggy = fish.with_values({"skin_friction.along": 2.0})
    others = [replace(p, free=p.name == "skin_friction.along") for p in draggy.parameters.values()]
    save_model(replace(draggy, parameters={p.name: p for p in others}), tmp_path / "draggy.yaml")
    out = ["--output", str(tmp_path), "--json", str(tmp_path / "fit.json"), "--jobs", "1"]
    assert main([str(tmp_path / "swum.csv"), "--model", str(tmp_path / "draggy.yaml"), *out]) == 0
    said = capsys.readouterr().out
    assert "swimming speed of the head marker" in said and "mean |Δ speed|" in said
    found = json.loads((tmp_path / "fit.json").read_text())
    run = found["runs"][0]
    assert run["simulated_speed_m_per_s"] == pytest.approx(run["speed_m_per_s"], rel=0.03)
    assert found["parameters"]["skin_friction.along"]["value"] == pytest.approx(1.0, abs=0.1)
    report = (tmp_path / "report.html").read_text()
    assert '<table class="cards" id="speeds">' in report
    for key in ("speed_m_per_s", "simulated_speed_m_per_s"):
        assert f"{1e3 * run[key]:.2f} mm/s" in report


def test_a_dry_body_has_no_speed(swum):
    """Nor one whose film is in pixels."""
    dry = compare(
        load_model("swimmer").with_numerics(mesh_density=0.5), [experiment_of(swum)], SerialExecutor()
    )
    assert dry.runs[0].speed is None and speed_table([dry]) is None
    assert dry.mean_speed_error is None
