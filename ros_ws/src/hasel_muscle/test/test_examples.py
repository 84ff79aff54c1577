# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The documented examples do what they say."""

import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest
from hasel_recording.errors import RecordingWarning
from hasel_sim.model.muscle_file import load_muscle, muscle_text
from hasel_sim.muscle.swing import GRAVITY, HangingLoad

EXAMPLES = Path(__file__).parents[1] / "docs" / "examples"
SWING = {"damping": 0.64, "slowness": 1.0, "lag": 0.007}
LOAD = 0.06 * GRAVITY


@pytest.fixture
def example(monkeypatch):
    """Loads an example as a module."""

    def load(name: str):
        specification = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
        module = importlib.util.module_from_spec(specification)
        monkeypatch.setitem(importlib.import_module("sys").modules, name, module)
        specification.loader.exec_module(module)
        return module

    return load


def test_a_load_under_fast_sines_beats_once_in_two_periods(example, tmp_path, capsys):
    """At twice its own frequency, and not under slow ones; what a recording of the law shows is what the law says."""
    bench_sines = example("bench_sines")
    stiff = load_muscle("peano_hasel").with_effects("parallel_stiffness")
    muscle = stiff.with_values({"parallel_stiffness.stiffness": 39.0})
    time = np.arange(0.0, 17.0, 1e-3)
    frequency = np.where(time < 8.0, 3.0, 15.0)
    volts = 3100.0 + 2100.0 * np.sin(2 * np.pi * frequency * time)
    volts[(time < 1.0) | ((time >= 7.0) & (time < 8.0))] = 0.0
    x = HangingLoad(muscle, LOAD, volts.max(), **SWING).contraction(time, volts)
    rows = np.column_stack([time, volts, 1e3 * x, np.full(len(time), LOAD)])
    path = tmp_path / "sines.csv"
    np.savetxt(path, rows, "%.6f", ",", header="time_s,voltage_v,contraction_mm,load_n", comments="")
    slow, fast = bench_sines.stretches(bench_sines.read_bench(path), muscle, SWING)
    assert (slow.frequency, fast.frequency) == (3.0, 15.0)
    assert slow.measured.half < 0.02 * slow.measured.once
    assert fast.measured.half > fast.measured.once
    for each in (slow, fast):
        assert each.measured.peak_to_peak == pytest.approx(each.simulated.peak_to_peak, rel=0.01)
    (tmp_path / "muscle.yaml").write_text(muscle_text(muscle))
    (tmp_path / "found.json").write_text(json.dumps({"swinging": {"values": SWING}}))
    bench_sines.main([str(tmp_path / name) for name in ("muscle.yaml", "found.json", "sines.csv")])
    assert len(capsys.readouterr().out.splitlines()) == 3


def test_the_law_beats_a_table_on_lifts_that_follow_it(example, tmp_path, capsys):
    """With every second voltage and with the lowest only; what is left to the law is the noise."""
    muscle = load_muscle("peano_hasel").with_values({"pouch.fill": 1.1})
    levels = np.arange(1000.0, 8001.0, 500.0)
    time = np.arange(0.0, 1.0 + 3.0 * len(levels), 0.02)
    lift = np.clip(np.floor((time - 1.0) / 3.0), 0, len(levels) - 1).astype(int)
    volts = np.where((time >= 1.0) & (np.mod(time - 1.0, 3.0) < 2.0), levels[lift], 0.0)
    strokes = muscle.balanced(levels, np.full(len(levels), LOAD), np.full(len(levels), LOAD))
    x = np.where(volts > 0, strokes[lift], 0.0) + 1e-5 * np.random.default_rng(2).standard_normal(len(time))
    path = tmp_path / "lifts.csv"
    rows = np.column_stack([time, volts, 1e3 * x, np.full(len(time), LOAD)])
    np.savetxt(path, rows, "%.6f", ",", header="time_s,voltage_v,contraction_mm,load_n", comments="")
    with pytest.warns(RecordingWarning, match="the package's own"):
        example("law_against_table").main([str(path)])
    lines = capsys.readouterr().out.splitlines()[1:]
    assert len(lines) == 6
    for line in lines:
        law, table = map(float, line.split("|")[1:])
        assert law < 0.01 and law < 0.3 * table
