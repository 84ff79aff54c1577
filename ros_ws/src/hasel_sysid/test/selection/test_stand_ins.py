"""What is fitted because it may stand in the place of a chosen effect."""

from dataclasses import replace

import pytest
from hasel_sysid.selection import POLICY, choose, search
from hasel_sysid.testing.linear_choice import WHITE, Judged, LookOtherwiseAtFirst, made_up
from hasel_sysid.testing.linear_sets import LinearSets


@pytest.mark.parametrize("known", [("ad", "a", "b"), ("ad",)], ids=["known alone", "never fitted"])
def test_what_looks_like_a_chosen_one_is_fitted_in_its_place(known):
    """A search that begins with the right set, and so looks no further, still learns what else may stand there."""
    series = made_up(1)
    series["b"] = series["a"] + 0.01 * series["b"]
    sets = LinearSets(series, {"a": 0.1, "d": 0.3}, WHITE, 1)
    begun = tuple(sets.fit(frozenset(one), sets.baseline(), ()) for one in known)
    choice = choose(search(sets, POLICY, begun=begun), POLICY)
    assert choice.groups == (("a", "b"),)


def test_what_looks_like_the_chosen_one_is_fitted_though_a_larger_set_is_worth_more():
    """What cannot be told from the answer is asked of the answer, not of a set that is better by a trifle."""
    series = made_up(1)
    series["b"], series["d"] = (series["a"] + 0.02 * series[name] for name in "bd")
    sets = LinearSets(series, {"a": 0.05, "c": 0.006}, WHITE, 1)
    begun = tuple(sets.fit(frozenset(one), sets.baseline(), ()) for one in ("a", "ac"))
    found = search(sets, POLICY, begun=begun)
    choice = choose(found, POLICY)
    assert found.best == {"a", "c"}
    assert (choice.chosen, choice.groups) == ({"a"}, (("a", "b", "d"),))


def test_what_looks_like_a_chosen_one_need_not_be_fitted_if_it_is_told_apart():
    """Of eight that look somewhat like it, the one that promises most says that none can stand in its place."""
    series = made_up(1)
    for name in "bcefghij":
        series[name] = series["a"] + 0.4 * series[name]
    sets = LinearSets(series, {"a": 0.1, "d": 0.3}, WHITE, 1)
    found = search(
        sets, POLICY, begun=tuple(sets.fit(frozenset(one), sets.baseline(), ()) for one in ("ad", "d"))
    )
    assert choose(found, POLICY).chosen == {"a", "d"}
    assert sum(len(effects) == 2 and "d" in effects for effects in found.known) == 2


def test_what_is_not_named_is_not_looked_for_in_other_shapes():
    """Effects that would not be said to be missing need no look-alikes, and the choice is the same without them."""
    series = made_up(1)
    series["b"] = series["a"] + 0.01 * series["b"]
    sets = LinearSets(series, {"a": 0.1, "d": 0.3}, WHITE, 1)
    begun = tuple(sets.fit(frozenset(one), sets.baseline(), ()) for one in ("ad", "d"))
    named, unnamed = (
        search(sets, POLICY, begun=begun, judges=Judged(is_named=lambda _, answer=answer: answer))
        for answer in (True, False)
    )
    assert choose(named, POLICY).chosen == choose(unnamed, POLICY).chosen == {"a", "d"}
    assert choose(named, POLICY).groups == (("a", "b"),)
    assert frozenset("bd") in set(named.known) - set(unnamed.known)


def test_what_may_stand_in_a_place_is_looked_at_beside_the_rest():
    """Beside the baseline the double of the chosen one looks like something else, and four others look more like it."""
    series = made_up(1)
    series["b"] = series["a"] + 0.01 * series["b"]
    sets = LookOtherwiseAtFirst(series, {"a": 0.1, "d": 0.3}, WHITE, 1)
    begun = tuple(sets.fit(frozenset(one), sets.baseline(), ()) for one in ("ad", "d"))
    assert choose(search(sets, POLICY, begun=begun), POLICY).groups == (("a", "b"),)


class _BLooksOtherwiseAtFirst(LookOtherwiseAtFirst):
    """Of all effects b alone, which puts the baseline out of step."""

    as_they_are = frozenset("acdefghijk")


def test_what_was_fitted_alone_is_tried_in_a_place_however_little_it_looks_like_it():
    """Eight others look more like the chosen one than its double does, whose size is known."""
    series = made_up(1, "abcdefghijk")
    for name in "cefghijk":
        series[name] = series["a"] + 0.4 * series[name]
    series["b"] = series["a"] + 0.01 * series["b"]
    sets = _BLooksOtherwiseAtFirst(series, {"a": 0.1, "d": 0.3}, WHITE, 1)
    begun = tuple(sets.fit(frozenset(one), sets.baseline(), ()) for one in ("ad", "d", "b"))
    assert choose(search(sets, POLICY, begun=begun), POLICY).groups == (("a", "b"),)


class _Boasts(LookOtherwiseAtFirst):
    """What c promises beside other effects is all, and it keeps little of it."""

    def _prospect(self, of, name):
        found = super()._prospect(of, name)
        return replace(found, residual=0.0 * found.residual) if of.effects and name == "c" else found


def test_what_breaks_its_promise_does_not_speak_for_the_next():
    """The double of the chosen one promises less than a boaster, and is fitted after it all the same."""
    series = made_up(1)
    series["b"] = series["a"] + 0.01 * series["b"]
    series["c"] = series["a"] + 0.4 * series["c"]
    sets = _Boasts(series, {"a": 0.1, "d": 0.3}, WHITE, 1)
    begun = tuple(sets.fit(frozenset(one), sets.baseline(), ()) for one in ("ad", "d"))
    found = search(sets, POLICY, begun=begun)
    assert frozenset("cd") in found.known
    assert choose(found, POLICY).groups == (("a", "b"),)
