# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A quick part of the benchmark: the six shorter runs are fitted, a third of the cost of all nine."""

import pytest
from hasel_benchmark.bench_hidden.hidden_cases import Case
from hasel_benchmark.bench_hidden.laboratory import measure
from hasel_benchmark.bench_hidden.outcome import judge
from hasel_benchmark.bench_hidden.run_cases import explain
from hasel_bringup.hidden_truth.plan import FITTED

SHORT = [box for box in FITTED if box.frequency > 1]
pytestmark = pytest.mark.timeout(900)


def outcome(pool, kind, effects, size=1.0, colour="white"):
    """What became of one case of the near truth."""
    case = Case(kind, effects, size, 0, colour, "near")
    laboratory = measure(case, pool, fitted=SHORT)
    return judge(case, laboratory, explain(laboratory, pool), seconds=0.0)


def test_nothing_is_missing_when_nothing_is_hidden(pool):
    """Correlated noise and another mesh are no effect."""
    found = outcome(pool, "nothing", (), 0.0, "coloured")
    assert found.status == "nothing_missing"
    assert found.missing == ()


@pytest.mark.parametrize(
    ("effect", "size"),
    # without its drag the body swings so much that the baseline is fitted with a third of the muscles' strength
    [pytest.param("muscle_asymmetry", -2.0, marks=pytest.mark.slow), ("quadratic_drag", 1.0)],
)
def test_hidden_effect_is_named_and_added(pool, effect, size):
    """First in the ranking, added alone, and most of the error gone on runs that were not fitted."""
    found = outcome(pool, "single", (effect,), size)
    assert found.visible
    assert found.ranked[0] == effect
    assert found.missing == (effect,)
    assert found.removed_fitted > 0.9
    assert found.removed_unseen > 0.8


@pytest.mark.slow
@pytest.mark.parametrize("effect", ["one_sided_dead_zone", "stirred_bath"])
def test_what_no_catalogue_lists_is_not_explained_away(pool, effect):
    """A muscle that starts late resembles a weak one at one voltage only; a push from outside, nothing listed."""
    found = outcome(pool, "unlisted", (effect,), 1.0)
    assert found.visible
    assert found.says_none_of_them
