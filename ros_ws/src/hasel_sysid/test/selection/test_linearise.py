# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What candidates do beside a fitted set, to first order."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.candidates import effects_of
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.estimation.starts import screen, starts
from hasel_sysid.selection.likelihood import FittedSet
from hasel_sysid.selection.linearise import linearise, own_columns, room, secant
from hasel_sysid.testing.made_up_world import MadeUpWorld

SHARE, TIME = "initial_relaxation.share", "initial_relaxation.relaxation_time"


@pytest.fixture(scope="module")
def heavy():
    """A world in which a payload and a drag are hidden, the fit of the model with the payload, and the candidates."""
    world = MadeUpWorld(1)
    problem = world.measured(world.with_typical("payload", "linear_drag"))
    candidates = {c.name: c for c in effects_of(world.model)}
    fit = fit_baseline(problem, world.model.with_effects("payload"))
    return problem, FittedSet({"payload": candidates["payload"]}, fit), candidates


def test_a_candidate_is_linearised_where_it_starts(heavy):
    """Change and derivatives together foretell what a quarter more of its size does."""
    problem, about, candidates = heavy
    (start,) = (s for s in starts(candidates["linear_drag"]) if s.typical)
    (found,) = linearise(problem, about, [start])
    assert found.names == tuple(start.values)
    more = {name: 1.25 * value for name, value in start.values.items()}
    there = problem.evaluate(start.model(about.fit.model).with_values(more))
    step = np.array([0.25 * start.values[name] for name in found.names])
    assert about.residual - there.residual == pytest.approx(found.change + found.jacobian @ step, abs=1e-8)
    assert found.looks.shape == (len(about.residual), 2)


def test_without_a_candidate_of_its_own_a_set_leaves_its_change_more(heavy):
    """In a world in which sizes act in proportion."""
    problem, about, _ = heavy
    bare = problem.evaluate(about.fit.model.with_values({"payload.mass": 0.0}))
    assert about.residual + own_columns(about, "payload").change == pytest.approx(bare.residual, abs=1e-8)


def test_a_secant_is_the_change_by_its_typical_size(heavy):
    """All sizes in proportion to it, as far as their range goes."""
    problem, about, candidates = heavy
    (one,) = screen(
        problem, about.fit.evaluation, [s for s in starts(candidates["linear_drag"]) if s.typical]
    )
    found = secant(one)
    (p,) = candidates["linear_drag"].parameters
    assert found.change == pytest.approx(found.jacobian[:, 0] * p.typical)
    assert (found.lower[0], found.upper[0]) == pytest.approx((p.lower - p.typical, p.upper - p.typical))


def test_a_size_may_go_anywhere_within_its_range_and_a_time_by_half_of_itself():
    """Derivatives say nothing of a time ten times as long."""
    model = load_model("beam").with_effects("initial_relaxation").with_values({SHARE: 0.1, TIME: 2.0})
    down, up = room(model, (SHARE, TIME))
    share = model.parameters[SHARE]
    assert [down[0], up[0]] == pytest.approx([share.lower - 0.1, share.upper - 0.1])
    assert [down[1], up[1]] == pytest.approx([-1.0, 1.0])
