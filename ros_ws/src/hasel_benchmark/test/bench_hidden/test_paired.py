# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Two searches on the same cases."""

from dataclasses import replace

import pytest
from hasel_benchmark.bench_hidden.outcome import Outcome
from hasel_benchmark.bench_hidden.paired import group_sizes, paired, times
from statsmodels.stats.contingency_tables import mcnemar

SEEN = {"mae_fitted": (0.0104, 0.0028), "floor_fitted": 0.0024, "seconds": 50.0}


def outcome(number: int, right: bool, **changes) -> Outcome:
    """A drag is hidden; it is named, or a tether."""
    first = "linear_drag" if right else "tether"
    said = {"status": "explained", "missing": (first,), "ranked": (first,)}
    content = {**SEEN, **said, **changes}
    return Outcome(f"case {number}", "single", ("linear_drag",), 1.0, "white", "near", **content)


def test_the_chance_is_that_of_mcnemars_exact_test():
    """Of 30 cases one is won and seven are lost: as statsmodels has it."""
    before = [outcome(n, n >= 1) for n in range(30)]
    after = [outcome(n, n == 0 or n >= 8) for n in range(30)]
    (first, *_) = paired({o.case: o for o in before}, after)
    assert (first.before, first.after, first.cases) == (29, 23, 30)
    assert len(first.only_before) == 7 and first.only_after == ("case 0",)
    expected = mcnemar([[22, 7], [1, 0]], exact=True).pvalue
    assert first.chance == pytest.approx(expected)


def test_only_cases_that_both_answered_are_compared():
    """A failure of either is no answer, and a case that one has alone is no pair."""
    before = {o.case: o for o in (outcome(0, True), outcome(1, True, failure="it broke"), outcome(2, True))}
    after = [outcome(0, True, seconds=100.0), outcome(1, True), outcome(3, False)]
    (first, *_) = paired(before, after)
    assert (first.cases, first.chance) == (1, 1.0)
    assert "median ratio 2.00" in times(before, [after[0]])
    group = ("linear_drag", "payload", "tether")
    assert group_sizes(before, [replace(after[0], groups=(group,))]).endswith("before and after: 1.00, 3.00")
    assert times({}, after) == "no case was timed by both"


def test_a_case_is_paired_where_it_is_visible_to_both():
    """What leaves hardly a trace for one of the two is counted in neither share."""
    hidden = replace(outcome(0, True), mae_fitted=(0.0024, 0.0024))
    (first, *_) = paired({"case 0": hidden}, [outcome(0, True)])
    assert first.cases == 0
