"""The fastest frequency and its interval."""

import numpy as np
import pytest
from hasel_sim.swimming.optimum import optimum, standard_error_of


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
