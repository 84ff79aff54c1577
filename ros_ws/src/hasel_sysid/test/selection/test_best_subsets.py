# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Best subset selection, against fits of every set."""

from itertools import combinations

import numpy as np
import pytest
from hasel_sysid.selection.best_subsets import best_subsets
from hasel_sysid.testing.linear_world import SLOW, WHITE, LinearWorld, unlike_series
from scipy.optimize import lsq_linear

NAMES = "abcdef"
PENALTY = 3.0


@pytest.mark.parametrize("about", ["", "a", "ef"], ids=["baseline", "about one", "about two"])
@pytest.mark.parametrize("noise", [WHITE, SLOW], ids=["white", "shared by neighbours"])
def test_it_is_brute_force_over_all_sets(about, noise):
    """For a linear problem the log-likelihood of every set is that of its own generalised least squares."""
    for seed in range(2):
        world = LinearWorld(unlike_series(seed, NAMES), {"b": 0.05, "c": -0.03, "e": 0.02}, noise, seed)
        fitted = world.fitted(about)
        rows = best_subsets(fitted, world.columns(fitted), world.likelihood, 3, PENALTY)
        every = {frozenset(s): 0.0 for size in range(4) for s in combinations(NAMES, size)}
        every = {names: world.logarithm(names) for names in every}
        ranked = sorted(every, key=lambda names: PENALTY * len(names) - every[names])
        assert [row.names for row in rows] == ranked[: len(rows)]
        assert len(rows) >= 20
        assert [row.logarithm for row in rows] == pytest.approx([every[row.names] for row in rows], rel=1e-6)


def test_values_are_those_of_generalised_least_squares():
    """A fit of the row begins at its optimum."""
    world = LinearWorld(unlike_series(3, NAMES), {"b": 0.05, "c": -0.04}, WHITE, 3)
    fitted = world.fitted("a")
    for row in best_subsets(fitted, world.columns(fitted), world.likelihood, 3, PENALTY)[:10]:
        exact = world.fitted(row.names).fit.model.values
        assert {name: row.values[name] for name in exact} == pytest.approx(exact, rel=1e-3, abs=1e-6)


def test_bounds_of_the_parameters_hold():
    """A set whose effect would have to be larger than its range is ranked at the end of the range, as scipy has it."""
    world = LinearWorld(unlike_series(5, "ab"), {"a": 0.3, "b": 0.1}, WHITE, 5, largest=0.2)
    fitted = world.fitted("")
    rows = {r.names: r for r in best_subsets(fitted, world.columns(fitted), world.likelihood, 2, PENALTY)}
    both = rows[frozenset("ab")]
    assert both.values["a.size"] == pytest.approx(0.2)
    columns = np.column_stack([fitted.jacobian, world.series["a"], world.series["b"]])
    scale = np.linalg.norm(columns, axis=0)
    white = world.likelihood.whiten(np.column_stack([fitted.residual, columns / scale]))
    reach = np.array([np.inf, 0.2, 0.2]) * scale
    expected = lsq_linear(white[:, 1:], white[:, 0], (-reach, reach), tol=1e-12)
    assert both.logarithm == pytest.approx(-expected.cost, rel=1e-6)


def test_incompatible_candidates_are_in_no_set_together():
    """Of two that do the same the best that can be had is one of them."""
    world = LinearWorld(unlike_series(2, "abc"), {"a": 0.05, "b": 0.04}, WHITE, 2)
    for name in "ab":
        world.candidates[name].effect.exclusive = "the same"
    fitted = world.fitted("")
    rows = best_subsets(fitted, world.columns(fitted), world.likelihood, 3, PENALTY)
    assert frozenset("ac") in [row.names for row in rows]
    assert not [row for row in rows if row.names >= {"a", "b"}]
