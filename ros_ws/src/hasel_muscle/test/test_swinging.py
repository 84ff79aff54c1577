# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A load that swings after every lift."""

import json
from dataclasses import replace

import numpy as np
import pytest
from hasel_muscle.bench_muscle import main
from hasel_muscle.bench_recording import BenchRecording
from hasel_muscle.swinging import swinging
from hasel_sim.model.muscle_file import load_muscle
from hasel_sim.muscle.swing import GRAVITY, HangingLoad

TRUTH = {"damping": 0.6, "slowness": 1.2, "lag": 0.008}
LEVELS = (2000.0, 3000.0, 4000.0, 5000.0, 6000.0, 7000.0)
LOAD = 0.06 * GRAVITY


@pytest.fixture(scope="module")
def muscle():
    """The package's muscle with a stiffness of its own, so that a load swings about where it settles."""
    return (
        load_muscle("peano_hasel")
        .with_effects("parallel_stiffness")
        .with_values({"parallel_stiffness.stiffness": 30.0})
    )


@pytest.fixture(scope="module")
def swung(muscle) -> BenchRecording:
    """Lifts of 2 s with rests of 1 s, a thousand samples per second, a hundredth of a millimetre of noise."""
    time = np.arange(0.0, 1.0 + 3.0 * len(LEVELS), 1e-3)
    number = np.clip(np.floor((time - 1.0) / 3.0), 0, len(LEVELS) - 1).astype(int)
    on = (time >= 1.0) & (np.mod(time - 1.0, 3.0) < 2.0)
    voltage = np.where(on, np.array(LEVELS)[number], 0.0)
    x = HangingLoad(muscle, LOAD, max(LEVELS), **TRUTH).contraction(time, voltage)
    x = x + 1e-5 * np.random.default_rng(1).standard_normal(len(time))
    return BenchRecording("swung", time, voltage, x, np.full(len(time), LOAD))


def test_damping_slowness_and_lag_are_found(swung, muscle):
    """Within their errors, on fitted and on unseen lifts; without inertia the law is far off."""
    found = swinging([swung], muscle, unseen=(3000.0,))
    assert [lift.level for lift in found.lifts] == list(LEVELS)
    assert [lift.unseen for lift in found.lifts] == [level == 3000.0 for level in LEVELS]
    for name, value in TRUTH.items():
        assert found.values[name] == pytest.approx(value, rel=0.03)
    for unseen in (False, True):
        assert found.mean_error(unseen) < 2e-5 < 20e-5 < found.mean_error(unseen, alone=True)
    for lift in found.lifts:
        assert lift.peak[1] == pytest.approx(lift.peak[0], rel=0.02, abs=5e-5)
    assert "swings" in str(found) and "on unseen voltages" in str(found)


def test_what_shows_no_swing_is_left_alone(swung, muscle):
    """Too few samples per second, a held length, too few lifts."""
    slow = replace(
        swung, **{name: getattr(swung, name)[::10] for name in ("time", "voltage", "contraction", "load")}
    )
    short = swung.time < 9.0
    few = replace(
        swung, **{name: getattr(swung, name)[short] for name in ("time", "voltage", "contraction", "load")}
    )
    for recording in (slow, replace(swung, held="contraction"), few):
        assert swinging([recording], muscle) is None


def test_the_command_shows_it(swung, muscle, tmp_path, capsys):
    """A table, a sentence, the report and JSON."""
    step = 4
    rows = [
        f"{t:.3f},{v:.1f},{1e3 * x:.5f}"
        for t, v, x in zip(swung.time[::step], swung.voltage[::step], swung.contraction[::step], strict=True)
    ]
    path = tmp_path / "lifts.csv"
    path.write_text(f"#load_n: {LOAD}\ntime_s,voltage_v,contraction_mm\n" + "\n".join(rows) + "\n")
    options = ["--muscle", "peano_hasel", "--effects", "parallel_stiffness", "--settling", "0.6"]
    out = ["--output", str(tmp_path), "--json", str(tmp_path / "bench.json")]
    assert main([str(path), *options, *out]) == 0
    said = capsys.readouterr().out
    assert "swinging in the first 0.5 s" in said and "the load swings" in said
    found = json.loads((tmp_path / "bench.json").read_text())["swinging"]
    assert len(found["lifts"]) == len(LEVELS)
    assert found["values"]["damping"] == pytest.approx(TRUTH["damping"], rel=0.2)
    assert 'id="swinging"' in (tmp_path / "bench_muscle.html").read_text()
