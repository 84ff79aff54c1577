"""Beside which sets a search looks at further effects, and how far beyond the likeliest one."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.selection import POLICY, choose, search
from hasel_sysid.testing.linear_choice import WHITE, Judged, LookOtherwiseAtFirst, chosen, made_up
from hasel_sysid.testing.linear_sets import LinearSets


def test_what_is_left_is_looked_at_from_where_it_is_left():
    """Beside the baseline the second one looks like nothing that the first one leaves; beside the first one it does."""
    for seed in range(3):
        sets = LookOtherwiseAtFirst(made_up(seed), {"a": 0.3, "d": 0.05}, WHITE, seed)
        assert chosen(sets)[0] == "ad"


class _NothingShowsTheNoise(LookOtherwiseAtFirst):
    """Nor is it known otherwise than by what the best set leaves."""

    def noise(self, known):
        """What is least among the squares that are left."""
        return NoiseModel(min(fitted.squares for fitted in known) / len(self.runs), 0.0, 0.5)


def test_what_fails_somewhere_is_looked_beyond_though_nothing_else_tells_it_from_noise():
    """What the best set leaves cannot exceed a noise that is known by it alone; its shares can be no noise."""
    for seed in range(3):
        sets = _NothingShowsTheNoise(made_up(seed), {"a": 0.3, "d": 0.05}, WHITE, seed)
        found = search(sets, POLICY)
        assert choose(found, POLICY).chosen == {"a"}
        found = search(sets, POLICY, judges=Judged(describes=frozenset("ad").__eq__))
        assert choose(found, POLICY).chosen == {"a", "d"}


class _HiddenByAConstant(LinearSets):
    """Beside the baseline, d looks like one of the model's own constants."""

    def _prospect(self, of, name):
        found = super()._prospect(of, name)
        if of.effects or name != "d":
            return found
        return replace(found, jacobian=of.jacobian[:, [0, 1, 0]], looks=of.jacobian[:, :1])


def test_what_costs_nothing_is_looked_at_beside_every_set():
    """The second effect looks like nothing beside the baseline, and two others together look just like it."""
    series = made_up(1)
    series["d"] = series["b"] + series["c"]
    sets = _HiddenByAConstant(series, {"a": 0.3, "d": 0.1}, WHITE, 1)
    assert len(chosen(sets)[0]) == 3
    sets.at_null = "d"
    assert chosen(sets)[0] == "ad"


class _AloneALooksOtherwise(LookOtherwiseAtFirst):
    """What is missing looks like another effect beside the baseline, and like itself nowhere."""

    as_they_are = frozenset("bcdefghij")


def test_a_larger_set_is_left_for_its_parts_until_no_part_will_do():
    """Of three effects one is there; it was never fitted alone, nor was any two of them."""
    series = made_up(1)
    series["b"] = series["a"] + 1.5 * series["b"]
    sets = _AloneALooksOtherwise(series, {"a": 0.3}, WHITE, 1)
    begun = (sets.fit(frozenset("acd"), sets.baseline(), ()),)
    assert choose(search(sets, POLICY, begun=begun), POLICY).chosen == frozenset("a")


class _OutOfRange(LinearSets):
    """One of b and c without the other is out of range, and c promises nothing but beside b."""

    def prospects(self, of, wanted, rank, most, sized=None):
        """As of sets, c without room to move where b is not."""
        seen = super().prospects(of, wanted, rank, most, sized)
        if "c" in seen and "b" not in of.effects:
            room = np.array([*of.upper, 0.0])
            seen["c"] = replace(seen["c"], lower=np.array([*of.lower, 0.0]), upper=room)
        return seen

    def fit(self, effects, near, added):
        """As of sets, some of them out of range."""
        return replace(super().fit(effects, near, added), plausible=("b" in effects) == ("c" in effects))


def test_what_is_likeliest_but_out_of_range_is_looked_beyond():
    """It is never chosen itself; with what it stood in for beside it, it may be."""
    for seed in range(3):
        assert chosen(_OutOfRange(made_up(seed), {"a": 0.06, "b": 0.05, "c": 0.04}, WHITE, seed))[0] == "abc"
        assert "b" not in chosen(_OutOfRange(made_up(seed), {"a": 0.06, "b": 0.05}, WHITE, seed))[0]


class _SomeOutOfRange(LinearSets):
    """Whatever holds b has values out of their ranges."""

    def fit(self, effects, near, added):
        """As of sets, some of them out of range."""
        return replace(super().fit(effects, near, added), plausible="b" not in effects)


def test_what_is_out_of_range_is_no_answer_and_takes_no_answers_place():
    """The pair that promises most, out of range, does not keep the second of the possible ones from being fitted."""
    for seed in range(3):
        series = made_up(seed, "abgh")
        for share, name in ((0.1, "h"), (0.8, "g")):
            series[name] = series["b"] + share * series[name]
        sets = _SomeOutOfRange(series, {"a": 0.3, "b": 0.1}, WHITE, seed)
        assert {frozenset("ah"), frozenset("ag")} <= set(search(sets, POLICY, stand_ins=False).known)


def test_while_what_is_chosen_is_no_law_what_promises_as_much_is_fitted():
    """Of several that look alike only one not fitted yet is a law: it is fitted for that, and for nothing else."""
    series = made_up(5)
    for name in "bcefg":
        series[name] = series["a"] + 0.02 * series[name]
    sets = LinearSets(series, {"a": 0.05}, WHITE, 5)
    known = search(sets, POLICY, stand_ins=False).known
    left = {frozenset(name) for name in "abcefg"} - set(known)
    assert left
    for only in left:
        found = search(sets, POLICY, stand_ins=False, judges=Judged(is_law=only.__eq__))
        assert choose(found, POLICY, lambda effects, only=only: effects == only).chosen == only
    every = search(sets, POLICY, stand_ins=False, judges=Judged())
    assert set(every.known) == set(known)


class _WithinReach(LinearSets):
    """A first look at d sees no further than a little way, as where every other value must move far with it."""

    def _prospect(self, of, name):
        seen = super()._prospect(of, name)
        reach = np.where(np.arange(len(seen.upper)) == len(seen.upper) - 1, 0.03, np.inf)
        return replace(seen, lower=-reach, upper=reach) if name == "d" else seen


@pytest.mark.parametrize("seed", [0, 2])
def test_the_best_law_is_extended_by_what_promises_little(seed):
    """Two that together do as well as the chosen pair, which is no law, are fitted though the second is shy."""
    series = made_up(seed)
    series["d"] = series["a"] + series["b"] - series["c"] + 0.02 * series["d"]
    for name in "efgh":
        series[name] = series["a"] + 0.02 * series[name]
    sets = _WithinReach(series, {"a": 0.1, "b": 0.1}, WHITE, seed)
    assert frozenset("cd") not in search(sets, POLICY, stand_ins=False).known
    found = search(
        sets, POLICY, stand_ins=False, judges=Judged(is_law=lambda effects: effects <= frozenset("cd"))
    )
    assert choose(found, POLICY, lambda effects: effects <= frozenset("cd")).chosen == frozenset("cd")


class _SeenLate(LinearSets):
    """What b promises is seen beside two effects only; until then c, which looks like it, is."""

    def prospects(self, of, wanted, rank, most, sized=None):
        """As of sets, b without room to move where it is not seen."""
        seen = super().prospects(of, wanted, rank, most, sized)
        if "b" in seen and len(of.effects) < 2:
            room = np.array([*of.upper, 0.0])
            seen["b"] = replace(seen["b"], lower=np.array([*of.lower, 0.0]), upper=room)
        return seen


class _SeenLateAndBounded(_SeenLate):
    """What tells of the noise is a tenth as loud beside a bad fit; by that, what leaves noise leaves much."""

    def noise(self, known):
        """A tenth of the noise, until a fit comes near it."""
        near = min(fitted.squares for fitted in known) < 2 * len(self.runs) * WHITE.standard_deviation**2
        return WHITE if near else replace(WHITE, white=WHITE.white / 100, coloured=WHITE.coloured / 100)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("sets", [_SeenLate, _SeenLateAndBounded])
def test_what_wants_nothing_is_not_extended(sets, seed):
    """The third effect may come beside a stand-in or in its place, where a fit leaves nothing to be fitted further: by
    the noise that this fit shows.
    """
    series = made_up(seed)
    series["c"] = series["b"] + 0.7 * series["c"]
    found = search(sets(series, {"a": 0.3, "b": 0.2}, WHITE, seed), POLICY)
    assert choose(found, POLICY).chosen == frozenset("ab")
    assert frozenset("ac") in found.known
    assert max(map(len, found.known)) == 2
