# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Racing of single candidates on the low-fidelity model."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.candidates import effects_of
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.noise import NoiseModel
from hasel_sysid.problem import LowFidelityProblem
from hasel_sysid.selection.likelihood import Likelihood
from hasel_sysid.selection.race import at_other_sizes, at_typical_size, race, screen_typical
from hasel_sysid.testing.made_up_world import NOISE, MadeUpWorld, simulated_runs

SOME = ("payload", "pre_bend", "linear_drag", "viscoelastic_creep", "tether")


def laboratory(hidden, values, **limits):
    """A fitted baseline by the low-fidelity model, its likelihood, and some candidates at their typical sizes."""
    world = MadeUpWorld(3)
    problem = world.measured(world.with_typical(hidden).with_values(values), **limits)
    low = LowFidelityProblem(problem, fit_baseline(problem, world.model).evaluation)
    screened, _ = screen_typical(low, effects_of(world.model, SOME))
    return low, Likelihood(NoiseModel(NOISE**2, 0.0, 0.5), low.known.runs), screened


@pytest.mark.parametrize(
    ("hidden", "values"),
    [
        ("payload", {"payload.mass": 0.013}),
        ("pre_bend", {"pre_bend.curvature": -0.3}),
        ("viscoelastic_creep", {"viscoelastic_creep.relaxation_time": 1.6}),
    ],
    ids=["a third more than the typical size", "the other sign", "another time"],
)
def test_what_is_hidden_wins_with_its_value(hidden, values):
    """From typical sizes, whatever its sign or time: it ends at the noise, and no other comes near."""
    low, likelihood, screened = laboratory(hidden, values)
    ended = race(low, at_typical_size(low, screened, low.known.sum_of_squares), likelihood, reach=8.0)
    best = min(ended, key=lambda name: ended[name].sum_of_squares)
    assert best == hidden
    assert ended[best].sum_of_squares == pytest.approx(NOISE**2 * len(low.known.residual), rel=0.1)
    for name, value in values.items():
        assert ended[best].model.values[name] == pytest.approx(value, rel=0.1)
    assert all(ended[name].sum_of_squares > 2 * ended[best].sum_of_squares for name in ended if name != best)


@pytest.mark.parametrize(
    ("hidden", "values"),
    [
        ("payload", {"payload.mass": 0.13}),
        ("tether", {"tether.stiffness": 60.0, "tether.position": 0.12}),
        ("linear_drag", {"linear_drag.rate": 0.15}),
    ],
    ids=["thirteen times the typical size", "twelve times, near the tail", "a seventh of it"],
)
def test_what_is_far_from_its_typical_size_is_followed_furthest_from_another_one(hidden, values):
    """It is the first of those that are gone on with on all runs, and then ends at the noise."""
    low, likelihood, screened = laboratory(hidden, values)
    entries = at_other_sizes(low, screened, 3)
    assert entries[0][0] == hidden and len(entries) <= 3
    ended = race(low, entries, likelihood, reach=8.0)[hidden]
    assert ended.sum_of_squares == pytest.approx(NOISE**2 * len(low.known.residual), rel=0.1)


def test_where_time_is_over_no_other_size_is_tried():
    """What is known from typical sizes stays."""
    low, _, screened = laboratory("payload", {"payload.mass": 0.13}, most_evaluations=0)
    assert list(at_other_sizes(low, screened, 3)) == []


def test_beside_no_time_the_first_candidates_are_screened_all_the_same():
    """Eight of them; the others are listed as untried."""
    world = MadeUpWorld(3)
    problem = world.measured(world.with_typical("payload"), most_evaluations=0)
    low = LowFidelityProblem(problem, fit_baseline(problem, world.model).evaluation)
    every = effects_of(world.model)
    screened, untried = screen_typical(low, every)
    tried = {one.start.candidate.name for one in screened}
    assert len(tried) == 8
    assert {c.name for c in untried} == {c.name for c in every} - tried


def test_a_strong_lag_is_found_though_first_order_promises_little_of_it():
    """Beside a baseline whose amplitudes make up for it, a creep of the drive looks likelier at first."""
    model = load_model("swimmer").with_levels([3500.0, 5500.0]).with_values({"slope": 0.15})
    lag, creep = effects_of(model, ["charging_lag", "drive_creep"])
    charge, discharge = lag.names
    truth = lag.added_to(model).with_values({charge: 0.25, discharge: 0.25})
    problem = simulated_runs(truth, [(3500.0, 1.0), (5500.0, 1.0), (5500.0, 2.0)], np.arange(0, 2.0, 1 / 60))
    low = LowFidelityProblem(problem, fit_baseline(problem, model).evaluation)
    screened, _ = screen_typical(low, [lag, creep])
    likely = at_typical_size(low, screened, low.known.sum_of_squares)
    assert {name for name, _ in likely} == {creep.name}
    name, found = at_other_sizes(low, screened, 2)[0]
    assert name == lag.name
    assert [found.values[charge], found.values[discharge]] == pytest.approx([0.25, 0.25], rel=0.01)
