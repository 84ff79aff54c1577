# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Sweeps: side by side, in a file, broken off and taken up again.

The fastest frequency and its interval.
"""

import numpy as np
import pytest
from hasel_sim.errors import ModelError
from hasel_sim.parallel import SerialExecutor
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.free_swim import free_swim
from hasel_sim.swimming.sweep import (
    SweepLedger,
    fingerprint,
    optimum,
    standard_error_of,
    sweep,
    swim_together,
)

DRIVES = [Boxes(5500.0, 5500.0, f) for f in (2.0, 2.5, 3.0)]
DURATION = 2.0


@pytest.fixture(scope="module")
def swam(fish):
    """The three swims at once."""
    return sweep(SerialExecutor(), fish, DRIVES, DURATION)


def test_side_by_side_as_alone(fish, swam):
    """Each comes out as by itself, in the order asked for."""
    assert [one.drive for one in swam] == DRIVES
    alone = free_swim(fish, DRIVES[1].run(fish, DURATION), 2.5)
    assert swam[1].speed_m_per_s == pytest.approx(alone.speed, rel=1e-6)
    assert swam[1].power_w == pytest.approx(alone.power, rel=1e-6)


def test_goes_on_where_it_was_broken_off(tmp_path, fish, swam, monkeypatch):
    """What the file has whole is not swum again, a line cut in the middle is; the file then has all."""
    path = tmp_path / "deep" / "swim.csv"
    SweepLedger(path, fish, DURATION).add(swam[:2])
    path.write_text(path.read_text()[:-9])
    asked = []

    def counting(model, drives, duration):
        asked.extend(drives)
        return swim_together(model, drives, duration)

    monkeypatch.setattr("hasel_sim.swimming.sweep.swim_together", counting)
    counts = []
    found = sweep(SerialExecutor(), fish, DRIVES, DURATION, SweepLedger(path, fish, DURATION), counts.append)
    assert asked == DRIVES[1:]
    assert (counts[0], counts[-1]) == (1, 3)
    assert set(SweepLedger(path, fish, DURATION).known) == set(DRIVES)
    assert np.allclose([one.speed_m_per_s for one in found], [one.speed_m_per_s for one in swam])


def test_another_models_file_is_refused(tmp_path, fish):
    """Numbers of two models do not get into one table; another name is no other model."""
    SweepLedger(tmp_path / "swim.csv", fish, DURATION)
    heavier = fish.with_values({"reactive_force.coefficient": 1.2})
    for model, duration in ((heavier, DURATION), (fish, 3.0)):
        with pytest.raises(ModelError, match="holds swims of another model or duration"):
            SweepLedger(tmp_path / "swim.csv", model, duration)
    assert fingerprint(fish) != fingerprint(heavier)


def test_the_top_of_a_parabola_is_found_exactly():
    """In any order, between the points, whatever a swim that failed says."""
    f = np.array([4.0, 1.0, 2.0, 3.0, 5.0])
    u = 0.07 - 0.01 * (f - 2.7) ** 2
    u[-1] = np.nan
    found = optimum(f, u)
    assert (found.frequency, found.speed, found.at_edge) == (pytest.approx(2.7), pytest.approx(0.07), False)
    assert str(found) == "optimum 2.70 Hz, 70 mm/s"


def test_a_sweep_that_ends_on_its_way_up_has_no_optimum():
    """It says so, and gives no interval."""
    found = optimum([1.0, 2.0, 3.0], [1.0, 2.0, 3.0])
    assert found.at_edge and found.interval is None
    assert "no optimum within it" in str(found)
    assert optimum([1.0], [np.nan]) is None


def test_the_interval_follows_from_the_parameters(fish):
    """Two independent parameters that shift the top by known amounts: the root of the squares."""
    model = fish.with_values(
        {"slope": 0.264, "reactive_force.coefficient": 1.0},
        {"slope": 0.01, "reactive_force.coefficient": 0.05},
    )

    def speeds(cases):
        tops = [
            2.0 + 5.0 * (m.values["slope"] - 0.264) - 3.0 * (m.values["reactive_force.coefficient"] - 1.0)
            for m, _ in cases
        ]
        return [0.07 - 0.01 * (f - top) ** 2 for (_, f), top in zip(cases, tops, strict=True)]

    found = optimum([1.0, 2.0, 3.0], [0.06, 0.07, 0.06])
    error = standard_error_of(model, found, 0.5, speeds)
    assert error == pytest.approx(np.hypot(5.0 * 0.01, 3.0 * 0.05))
    assert standard_error_of(fish, found, 0.5, speeds) is None
    names = ("slope", "reactive_force.coefficient")
    # both errors move the top by 0.05 and 0.15 Hz, and what one adds the other takes away
    both = np.array([[1e-4, 0.6 * 0.01 * 0.05], [0.6 * 0.01 * 0.05, 0.05**2]])
    error = standard_error_of(model.with_covariance(names, both), found, 0.5, speeds)
    assert error == pytest.approx(np.sqrt(0.05**2 + 0.15**2 - 2 * 0.6 * 0.05 * 0.15))
