"""Which of the known sets is chosen, and which effects cannot be told from its own."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.selection import POLICY, choose, search
from hasel_sysid.selection.choice import alike
from hasel_sysid.testing.linear_choice import WHITE, chosen, made_up
from hasel_sysid.testing.linear_sets import LinearSets, run_numbers, smooth_series


def test_twins_are_a_group():
    """An effect whose series differs by less than the noise shows is named beside the chosen one."""
    for seed in range(3):
        series = made_up(seed)
        series["b"] = series["a"] + 0.02 * series["b"]
        name, choice, _ = chosen(LinearSets(series, {"a": 0.05}, WHITE, seed))
        assert name in "ab"
        assert choice.groups == (("a", "b"),)
        assert 0.02 < choice.weight_of("a") < 0.98


def test_what_stands_for_one_of_two_effects_is_its_group():
    """Two are hidden, and a third looks like one of them: it is fitted beside the other, and named with its double."""
    for seed in range(3):
        series = made_up(seed)
        series["b"] = series["a"] + 0.01 * series["b"]
        name, choice, _ = chosen(LinearSets(series, {"a": 0.1, "d": 0.2}, WHITE, seed))
        assert name in ("ad", "bd")
        assert choice.groups == (("a", "b"),)


def test_what_the_recordings_tell_apart_is_no_group():
    """Its weight is that of certainty."""
    _, choice, _ = chosen(LinearSets(made_up(1), {"a": 0.05}, WHITE, 1))
    assert choice.groups == ()
    assert choice.weight_of("a") > 0.95


def test_the_other_member_of_a_pair_may_have_a_twin():
    """The group is of that member alone."""
    series = made_up(3)
    series["b"] = series["a"] + 0.02 * series["b"]
    name, choice, _ = chosen(LinearSets(series, {"a": 0.05, "f": 0.05}, WHITE, 3))
    assert name in ("af", "bf")
    assert choice.groups == (("a", "b"),)


def test_two_that_stand_for_two_others_are_groups_of_those_they_look_like():
    """Exchanged one by one they would be told apart."""
    series = made_up(6)
    shift = 0.5 * series["j"]
    series["b"], series["g"] = series["a"] + shift, series["f"] - shift
    _, choice, _ = chosen(LinearSets(series, {"a": 0.05, "f": 0.05}, WHITE, 6))
    assert choice.chosen in ({"a", "f"}, {"b", "g"})
    assert choice.groups == (("a", "b"), ("f", "g"))


def test_while_no_set_describes_the_runs_the_differences_count_for_less():
    """Two that imitate a stranger much alike are not told apart, though their likelihoods are far from equal."""
    stranger = 0.3 * smooth_series(np.random.default_rng(99), run_numbers())
    series = {name: one + 2.0 * stranger for name, one in made_up(9, "ab").items()}
    series["b"] = series["a"] + 0.15 * series["b"]
    _, choice, found = chosen(LinearSets(series, {}, WHITE, 9, stranger=stranger))
    one, other = (found.whitened[frozenset(name)].logarithm for name in "ab")
    assert abs(one - other) > np.log(20.0)
    assert len(choice.alike) > 1 or len(choice.chosen) > 1


def test_what_is_left_beside_hardly_any_noise_makes_no_certainty():
    """Two laws that leave the same, to what neither describes, are a group, and neither has all of the weight."""
    stranger = 0.02 * np.random.default_rng(99).standard_normal(len(run_numbers()))
    series = made_up(5)
    series["b"] = series["a"] + 0.02 * series["b"]
    quiet = NoiseModel(1e-4**2, 0.0, 0.5)
    name, choice, found = chosen(LinearSets(series, {"a": 0.3}, quiet, 5, stranger=stranger))
    one, other = (found.whitened[frozenset(name)].logarithm for name in "ab")
    assert abs(one - other) > np.log(20.0)
    assert name in "ab"
    assert choice.groups == (("a", "b"),)
    assert 0.02 < choice.weight_of("a") < 0.98
    assert choice.weight_of("a") + choice.weight_of("b") > 0.95


def test_where_a_set_describes_the_runs_what_dies_away_is_told_apart():
    """In a single run that dies away every difference lasts for many frames, and none of it is doubt."""
    runs = run_numbers(1, 480)
    time = np.arange(480) / 120.0
    series = {name: np.exp(-time / 0.3) * np.cos(turns * time) for name, turns in (("a", 25.0), ("b", 27.0))}
    sets = LinearSets(series, {"a": 1.0}, NoiseModel(0.003**2, 0.0, 0.5), 1, runs=runs)
    known = tuple(sets.fit(frozenset(name), sets.baseline(), ()) for name in "ab")
    found = search(sets, POLICY, begun=known)
    worths = [found.worths[frozenset(name)].total for name in "ab"]
    assert worths[0] - worths[1] > 10
    assert not choose(found, POLICY).groups


def test_of_sets_that_cannot_be_told_apart_one_that_is_a_law_is_taken():
    """The lawless one is named for what it is; it stays where nothing else will do."""
    series = made_up(2)
    series["b"] = series["a"] + 0.01 * series["b"]
    found = search(LinearSets(series, {"a": 0.1, "d": 0.3}, WHITE, 2), POLICY)
    likelier = choose(found, POLICY).chosen
    other = likelier ^ {"a", "b"}
    choice = choose(found, POLICY, lambda effects: effects != likelier)
    assert (choice.chosen, choice.lawless, choice.alike) == (other, (likelier,), (other,))
    assert choice.path[-1] == other and not choice.groups
    nothing_else = choose(found, POLICY, lambda effects: "d" not in effects)
    assert (nothing_else.chosen, nothing_else.lawless) == (likelier, ())
    assert nothing_else.groups == (("a", "b"),)


@pytest.mark.parametrize("apart", [False, True], ids=["alike", "told apart"])
def test_of_sets_that_cannot_be_told_apart_one_within_its_ranges_comes_first(apart):
    """One that is worth a little more, but on the edge of a range, is left in the group; what is told apart stays."""
    series = made_up(2)
    series["b"] = series["a"] + (1.0 if apart else 0.01) * series["b"]
    found = search(LinearSets(series, {"a": 0.1, "d": 0.3}, WHITE, 2), POLICY)
    worth_most = choose(found, POLICY).chosen
    on_edge = replace(found.known[worth_most], on_edge=True)
    choice = choose(replace(found, known=found.known | {worth_most: on_edge}), POLICY)
    assert choice.chosen == (worth_most if apart else worth_most ^ {"a", "b"})
    assert choice.groups == (() if apart else (("a", "b"),))


def test_an_effect_that_does_nothing_stands_for_no_other():
    """While a stranger leaves much, hardly any set is told apart: one that takes nothing away is no law in a place."""
    series = made_up(1)
    stranger = smooth_series(np.random.default_rng(4), run_numbers())
    found = search(LinearSets(series, {"c": 0.42}, WHITE, 1, stranger), POLICY, stand_ins=False)
    choice = choose(found, POLICY)
    assert choice.chosen == frozenset("c")
    idle = [
        s
        for s in found.known
        if len(s) == 1 and alike(found, choice.chosen, s, POLICY) and s != choice.chosen
    ]
    assert idle
    assert choice.alike == (choice.chosen,) and not choice.groups
    assert choose(found, POLICY, lambda effects: effects != frozenset("c")).chosen == frozenset("c")
