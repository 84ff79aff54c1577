# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which derivatives are followed in the lane of a run."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.simulate import columns_of_lanes, simulate, simulate_many

NAMES = ("amplitude_3500", "amplitude_5500", "slope", "linear_drag.rate")


@pytest.fixture(scope="module")
def swimmer():
    """With amplitudes of two voltages, in a fluid that slows it."""
    model = load_model("swimmer").with_levels(np.array([3500.0, 5500.0])).with_effects("linear_drag")
    return model.with_values({"amplitude_3500": 0.03, "amplitude_5500": 0.06, "linear_drag.rate": 1.0})


def followed(model, runs) -> list[set[str]]:
    """Names of the parameters that are followed in the lane of every run."""
    prepared = [PreparedRun(model, run, NAMES) for run in runs]
    slopes = [run.contraction_slopes(run.plan.balance_times) for run in prepared]
    return [{NAMES[column] for column in columns} for columns in columns_of_lanes(prepared, slopes)]


def test_an_amplitude_is_followed_where_its_voltage_is_applied(swimmer, boxes):
    """What the mechanics sees, and the slope of all muscles, in every lane."""
    found = followed(swimmer, [boxes(duration=0.25, voltage=v) for v in (3500.0, 5500.0)])
    everywhere = {"slope", "linear_drag.rate"}
    assert found == [everywhere | {"amplitude_3500"}, everywhere | {"amplitude_5500"}]


def test_a_lane_with_less_to_follow_has_as_many_columns(swimmer, boxes):
    """A run without a drive beside one with it; its derivatives by what drives are zero, as alone."""
    runs = [boxes(duration=0.25, voltage=v) for v in (0.0, 3500.0)]
    assert list(map(len, followed(swimmer, runs))) == [3, 3]
    for run, beside in zip(runs, simulate_many([(swimmer, run) for run in runs], NAMES), strict=True):
        assert beside.slopes == pytest.approx(simulate(swimmer, run, NAMES).slopes, abs=1e-6)
    assert not beside.slopes[:, NAMES.index("amplitude_5500")].any()


def test_runs_of_several_voltages_give_what_they_give_alone(swimmer, boxes):
    """Derivatives by every amplitude, each in its place."""
    runs = [boxes(duration=0.2, voltage=v) for v in (3500.0, 5500.0)]
    found = simulate_many([(swimmer, run) for run in runs], NAMES)
    for run, beside, silent in zip(runs, found, ("amplitude_5500", "amplitude_3500"), strict=True):
        alone = simulate(swimmer, run, NAMES).slopes
        assert beside.slopes == pytest.approx(alone, abs=1e-6 * np.abs(alone).max())
        moved = {name for name, column in zip(NAMES, beside.slopes.T, strict=True) if column.any()}
        assert moved == set(NAMES) - {silent}


def test_a_place_at_its_end_goes_beside_one_that_moves(boxes):
    """A tether beyond the tail marker holds that marker, wherever it is said to be; one before it moves."""
    names, run = ["tether.position", "tether.stiffness"], boxes(duration=0.2, voltage=3500.0)
    held = load_model("swimmer").with_levels(np.array([3500.0])).with_effects("tether")
    held = held.with_values({"amplitude_3500": 0.03, "tether.stiffness": 20.0})
    tail = held.description.markers["tail"].x_m
    models = [held.with_values({"tether.position": place}) for place in (0.5 * tail, 1.2 * tail)]
    for order in (models, models[::-1]):
        for model, found in zip(order, simulate_many([(each, run) for each in order], names), strict=True):
            alone = simulate(model, run, names).slopes
            assert found.slopes == pytest.approx(alone, rel=1e-5, abs=1e-7 * np.abs(alone).max())
    assert not simulate(models[1], run, names).slopes[:, 0].any()
    assert simulate(models[0], run, names).slopes[:, 0].any()
