# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which sets of effects a search finds, against fits of every set."""

from itertools import combinations

import numpy as np
import pytest
from hasel_sysid.candidates import Candidate, effects_of
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.estimation.fit import exact, fitted_model
from hasel_sysid.policy import POLICY
from hasel_sysid.selection.choose import Judged, best_of
from hasel_sysid.selection.cross_validation import leave_one_run_out
from hasel_sysid.selection.likelihood import NOTHING, FittedSet
from hasel_sysid.selection.search import Search, Searched
from hasel_sysid.testing.made_up_world import MadeUpProblem, MadeUpWorld

SOME = ("payload", "pre_bend", "linear_drag", "viscoelastic_creep", "gravity_tilt")


def searched(problem: MadeUpProblem, only: tuple[str, ...] = SOME) -> Searched:
    """A search for what the fitted baseline lacks, among these effects."""
    model = problem.world.model
    fit = fit_baseline(problem, model)
    return Search(problem, fit, effects_of(model, only), POLICY, lambda *_: True, with_constants=False).run()


def brute_force(problem: MadeUpProblem, found: Searched, most: int) -> dict:
    """Every set of so many effects at most, fitted from standard starts and judged by the search's own likelihood."""
    model = problem.world.model
    candidates = {one.name: one for one in effects_of(model, SOME)}
    judged = {}
    for size in range(most + 1):
        for names in combinations(SOME, size):
            begin = fit_baseline(problem, model.with_effects(*names) if names else model)
            fit = exact(problem, begin, 1e-6)
            fitted = FittedSet({name: candidates[name] for name in names}, fit)
            white = found.likelihood.whitened(fitted)
            elpd = leave_one_run_out(white, fit.evaluation.measured(), POLICY.prior_runs)
            judged[frozenset(names)] = Judged(fitted, white, elpd)
    return judged


@pytest.mark.parametrize("seed", range(4))
def test_the_answer_is_within_one_standard_error_of_the_best_of_all_sets(seed):
    """In random worlds that look alike in half of what effects do, with two effects of any size and sign."""
    generator = np.random.default_rng(seed)
    world = MadeUpWorld(seed, shared=8)
    hidden = [str(name) for name in generator.choice(SOME, 2, replace=False)]
    truth = world.with_typical(*hidden)
    sizes = {f"{e.id}.{p.name}": p for e in truth.effects for p in e.parameters if not p.scan}
    truth = truth.with_values({n: generator.uniform(0.5, 2.0) * p.typical for n, p in sizes.items()})
    problem = world.measured(truth)
    found = searched(problem)
    every = brute_force(problem, found, 2)
    best = every[best_of(every)].elpd
    chosen = found.models[found.choice.chosen].elpd
    more = best.over(chosen)
    assert more.total <= max(POLICY.standard_errors * more.error, 0.5)
    assert found.choice.chosen == set(hidden)


def test_nothing_is_fitted_while_nothing_is_missing():
    """The score test is of the largest of all gains: in ten worlds of noise it is passed by one at most."""
    false = 0
    for seed in range(10):
        world = MadeUpWorld(seed)
        found = searched(world.measured(world.with_typical()))
        false += found.first.chance < POLICY.level
        if found.first.chance >= POLICY.level:
            assert set(found.models) == {NOTHING} and found.choice.chosen == NOTHING
    assert false <= 1


def test_what_is_left_looks_like_noise_beside_the_answer_alone():
    """The score test speaks against the baseline, and not against the answer."""
    world = MadeUpWorld(5)
    found = searched(world.measured(world.with_typical("payload")))
    assert found.choice.chosen == {"payload"}
    assert found.first.chance < POLICY.level <= found.last.chance


def test_a_stranger_leaves_something_missing():
    """Whatever imitates a part of it, the score test still says that something is missing from the baseline."""
    world = MadeUpWorld(5, shared=6)
    found = searched(world.measured(world.with_typical(), stranger=0.02))
    assert found.first.chance < POLICY.level


def test_what_has_a_twin_is_found_with_it():
    """Each of two that look alike to a tenth is fitted, and they are a group where noise does not tell them apart."""
    world = MadeUpWorld(2, alike={"linear_drag": "payload"})
    problem = world.measured(world.with_typical("payload"), noise=0.05)
    found = searched(problem)
    assert {frozenset({"payload"}), frozenset({"linear_drag"})} <= set(found.models)
    assert found.choice.groups == (("linear_drag", "payload"),)


def test_a_search_out_of_time_still_answers():
    """With the baseline, of which a first batch of effects was screened; the others are listed."""
    world = MadeUpWorld(5)
    problem = world.measured(world.with_typical("payload", "pre_bend"), most_evaluations=0)
    model = world.model
    every: list[Candidate] = effects_of(model)
    fit = fitted_model(problem.evaluate(model, model.free))
    found = Search(problem, fit, every, POLICY, lambda *_: True).run()
    tried = {one.start.candidate.name for one in found.screened}
    assert tried and found.untried
    assert set(found.untried) >= {one.name for one in every} - tried
    assert NOTHING in found.models
