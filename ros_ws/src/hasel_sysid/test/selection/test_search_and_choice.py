"""Which set of effects is chosen, on linear problems with a known truth and no simulator."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest
from hasel_sysid.noise import NoiseModel
from hasel_sysid.selection import POLICY, choose, search
from hasel_sysid.selection.choice import alike
from hasel_sysid.testing.linear_sets import LinearSets, run_numbers, smooth_series

WHITE = NoiseModel(0.03**2, 0.0, 0.5)
SLOW = NoiseModel(0.01**2, 0.03**2, 0.9)
NAMES = tuple("abcdefghij")


@dataclass(frozen=True)
class Judged:
    """What is said of sets beyond their likelihoods: everything is right unless told otherwise."""

    is_law: Callable[[frozenset], bool] = lambda effects: True
    describes: Callable[[frozenset], bool] = lambda effects: True
    is_named: Callable[[frozenset], bool] = lambda effects: True

    def lawful(self, found, effects):
        """Whether what a set adds is a law."""
        return self.is_law(effects)

    def described(self, found, effects):
        """Whether a set describes its runs."""
        return self.describes(effects)

    def named(self, found, effects):
        """Whether its effects would be said to be missing."""
        return self.is_named(effects)


def made_up(seed, names=NAMES, runs=None):
    """A series for every name, unlike each other."""
    generator = np.random.default_rng(seed)
    runs = run_numbers() if runs is None else runs
    return {name: smooth_series(generator, runs) for name in names}


def chosen(sets):
    """What is chosen, and all of it."""
    found = search(sets, POLICY)
    choice = choose(found, POLICY)
    return "".join(sorted(choice.chosen)), choice, found


@pytest.mark.parametrize("noise", [WHITE, SLOW], ids=["white", "shared by neighbours"])
@pytest.mark.parametrize("sizes", [{"c": 0.03}, {"c": 0.03, "g": -0.02}, {"a": 0.02, "d": 0.02, "j": 0.03}])
def test_what_is_there_is_chosen(sizes, noise):
    """One, two or three effects, each as large as the noise or smaller, and nothing beside them."""
    for seed in range(2):
        assert chosen(LinearSets(made_up(seed), sizes, noise, seed))[0] == "".join(sorted(sizes))


@pytest.mark.parametrize("noise", [WHITE, SLOW], ids=["white", "shared by neighbours"])
def test_noise_is_taken_for_noise(noise):
    """One in a hundred may be taken for an effect: of thirty no more than two are."""
    false = sum(chosen(LinearSets(made_up(seed), {}, noise, seed))[0] != "" for seed in range(30))
    assert false <= 2


def test_two_that_hide_each_other_are_found_together():
    """Each alone looks like a third one, which is nearly their difference: adding one by one would begin with that."""
    for seed in range(3):
        series = made_up(seed)
        series["b"] = series["a"] + 0.3 * series["b"]
        series["c"] = (series["b"] - series["a"]) / 0.3 + 0.25 * series["c"]
        assert chosen(LinearSets(series, {"a": -0.2, "b": 0.2}, WHITE, seed))[0] in ("ab", "c")
        assert chosen(LinearSets(series, {"a": -0.2, "b": 0.25}, WHITE, seed))[0] == "ab"


def test_what_only_stood_in_for_two_others_goes():
    """The likeliest single effect is a mixture of the two that are there."""
    for seed in range(3):
        series = made_up(seed)
        series["c"] = series["a"] + series["b"] + 0.5 * series["c"]
        assert chosen(LinearSets(series, {"a": 0.05, "b": 0.04}, WHITE, seed))[0] == "ab"


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


@pytest.mark.parametrize("known", [("ad", "a", "b"), ("ad",)], ids=["known alone", "never fitted"])
def test_what_looks_like_a_chosen_one_is_fitted_in_its_place(known):
    """A search that begins with the right set, and so looks no further, still learns what else may stand there."""
    series = made_up(1)
    series["b"] = series["a"] + 0.01 * series["b"]
    sets = LinearSets(series, {"a": 0.1, "d": 0.3}, WHITE, 1)
    begun = tuple(sets.fit(frozenset(one), sets.baseline(), ()) for one in known)
    choice = choose(search(sets, POLICY, begun=begun), POLICY)
    assert choice.groups == (("a", "b"),)


def test_while_much_is_missing_it_is_squares_that_are_compared():
    """A slow swing is a hundred times the power of a fast one, which noise that is slow as well shows more clearly."""
    time = np.tile(np.arange(80) / 120.0, 8)
    series = {"a": np.sin(2 * np.pi * 0.8 * time + 0.5), "b": np.sin(2 * np.pi * 20.0 * time)}
    noise = NoiseModel(1e-6, 0.05**2, 0.99)
    sets = LinearSets(series, {"a": 1.0, "b": 0.1}, noise)
    found = search(sets, replace(POLICY, most_effects=1))
    assert choose(found, POLICY).chosen == {"a"}
    assert chosen(sets)[0] == "ab"


def test_the_declared_discrepancy_excuses_no_more_than_its_size():
    """A drift of many times its rms is an effect, though it is slow as the discrepancy is, and what is fast is left."""
    runs = run_numbers(1, 480)
    time = np.arange(480) / 120.0
    series = {"a": np.exp(-time / 2.0), "b": np.exp(-time / 0.5) * np.sin(2 * np.pi * 40.0 * time)}
    quiet = NoiseModel(2e-5**2, 0.0, 0.5)
    sets = LinearSets(series, {"a": 0.06, "b": 0.01}, quiet, runs=runs, swing=0.3)
    found = search(sets, replace(POLICY, most_effects=1))
    assert choose(found, POLICY).chosen == {"a"}


def test_what_cannot_matter_is_not_fitted():
    """A second effect that surely is there, and would take away less than a larger set must."""
    seen = 0
    for seed in range(3):
        _, choice, found = chosen(LinearSets(made_up(seed), {"a": 0.05, "b": 0.006}, WHITE, seed))
        assert choice.chosen == {"a"}
        assert max(map(len, found.known)) == 1
        seen += found.last.chance < POLICY.level
    assert seen >= 2


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


def test_effects_that_exclude_each_other_are_never_together():
    """The best that can be had is one of them."""
    sets = LinearSets(made_up(2), {"a": 0.05, "b": 0.03}, WHITE, 2, exclusive=[frozenset("ab")])
    _, choice, found = chosen(sets)
    assert not choice.chosen >= {"a", "b"}
    assert not any(effects >= {"a", "b"} for effects in found.known)


def test_no_more_than_three():
    """Four are there: more effects than that could imitate anything."""
    found = search(LinearSets(made_up(4), dict.fromkeys("abcd", 0.05), WHITE, 4), POLICY)
    assert max(map(len, found.known)) == POLICY.most_effects
    assert found.last.chance < POLICY.level


def test_a_stranger_leaves_something_missing():
    """Whatever imitates a part of it, the last test still says that something is missing."""
    stranger = 0.1 * smooth_series(np.random.default_rng(99), run_numbers())
    series = made_up(5)
    series["a"] = series["a"] + 6.0 * stranger
    _, _, found = chosen(LinearSets(series, {}, WHITE, 5, stranger=stranger))
    assert found.first.chance < POLICY.level


def test_what_one_run_alone_asks_for_is_not_added():
    """A disturbance of a single run looks like an effect there, and the other runs know nothing of it."""
    for seed in range(3):
        series = made_up(seed)
        runs = run_numbers()
        disturbed = np.where(runs == 3, 0.08 * series["a"], 0.0)
        assert chosen(LinearSets(series, {}, WHITE, seed, stranger=disturbed))[0] == ""


def test_one_run_is_judged_by_its_parts():
    """Nothing else can be left out of it."""
    runs = run_numbers(1, 480)
    name, _, found = chosen(LinearSets(made_up(6, runs=runs), {"b": 0.05}, WHITE, 6, runs=runs))
    assert name == "b"
    assert len(found.worths[frozenset("b")].densities) == 4


def test_a_search_out_of_time_still_answers():
    """With what it has fitted: one set in any case."""
    sets = LinearSets(made_up(7), {"a": 0.05, "b": 0.04, "c": 0.04}, WHITE, 7, most_fits=0)
    _, _, found = chosen(sets)
    assert sets.fits == 1
    assert len(found.known) == 2


def test_a_trifle_is_seen_and_not_added():
    """It takes away a twentieth of the squared error: surely there, and less than what another mesh leaves."""
    seen = 0
    for seed in range(4):
        name, _, found = chosen(LinearSets(made_up(seed), {"a": 0.006}, WHITE, seed))
        assert name == ""
        seen += found.first.chance < POLICY.level
    assert seen >= 2


def test_what_finer_numerics_would_take_away_is_not_to_an_effects_credit():
    """An effect much like the change by a finer mesh is added for what that cannot be, and not for what it may be."""
    for seed in range(3):
        series = made_up(seed)
        mesh = 0.02 * (series["a"] + 0.3 * series["b"])
        assert chosen(LinearSets(series, {"a": 0.015}, WHITE, seed))[0] == "a"
        assert chosen(LinearSets(series, {"a": 0.015}, WHITE, seed, slack=[mesh]))[0] == ""
        assert chosen(LinearSets(series, {"a": 0.2}, WHITE, seed, slack=[mesh]))[0] == "a"


class LostOnTheWay(LinearSets):
    """A fit of two effects from the baseline ends where the baseline is."""

    def fit(self, effects, near, added):
        """As of sets, but for that."""
        fitted = super().fit(effects, near, added)
        if len(effects) > 1 and not near.effects:
            return replace(fitted, residual=self.baseline().residual)
        return fitted


def test_a_fit_that_was_lost_begins_again_from_the_smaller_set():
    """A set cannot fit worse than a part of it."""
    series = made_up(8)
    series["c"] = series["a"] - series["b"] + 0.3 * series["c"]
    sets = LostOnTheWay(series, {"a": 0.05, "b": 0.05}, WHITE, 8)
    name, _, found = chosen(sets)
    assert name == "ab"
    squares = {effects: fitted.squares for effects, fitted in found.known.items()}
    for effects in squares:
        below = [squares[part] for gone in effects if (part := effects - {gone}) in squares]
        assert squares[effects] <= 1.0001 * min(below, default=np.inf)


class _HeldUp(LinearSets):
    """Without one effect the others are so many times as far off as first order says; begun: where fits began."""

    times = 1.0

    def without(self, of, gone):
        """As of sets, but for that."""
        left = super().without(of, gone)
        return replace(left, residual=of.residual + self.times * (left.residual - of.residual))

    def fit(self, effects, near, added):
        """As of sets; what it begins beside is kept."""
        self.begun = [*getattr(self, "begun", []), (effects, near.effects)]
        return super().fit(effects, near, added)


@pytest.mark.parametrize("times", [1.0, 50.0])
def test_a_part_is_fitted_from_the_whole_unless_a_smaller_set_is_nearer(times):
    """Values that an effect has drawn to itself are no start without it; that is seen, first order does not tell."""
    sets = _HeldUp(made_up(3), {"a": 0.06, "b": 0.05, "c": 0.04}, WHITE, 3)
    sets.times = times
    assert chosen(sets)[0] == "abc"
    whole = [effects for effects, _ in sets.begun].index(frozenset("abc"))
    parts = [(effects, near) for effects, near in sets.begun[whole:] if effects < frozenset("abc")]
    assert parts
    assert all((near == effects) == (times == 1.0) for effects, near in parts)
    assert all(near <= effects for effects, near in parts)


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


class _TwoValleys(LinearSets):
    """A fit of one effect ends near the baseline, unless it begins from another size."""

    def from_other_sizes(self, of, prospect):
        """The same, known by where it is from."""
        return replace(prospect, start="another size")

    def fit(self, effects, near, added):
        """As of sets, or without what the effect could take away."""
        fitted = super().fit(effects, near, added)
        there = any(prospect.start == "another size" for prospect in added)
        return fitted if there or len(effects) != 1 else replace(fitted, residual=0.99 * near.residual)


def test_a_fit_that_breaks_its_promise_begins_again_from_other_sizes():
    """What was promised to first order is there, and the fit ended in another valley."""
    assert chosen(_TwoValleys(made_up(2), {"c": 0.05}, WHITE, 2))[0] == "c"


class _NoOtherValley(_TwoValleys):
    """Another size promises hardly anything; begun: where fits began."""

    def from_other_sizes(self, of, prospect):
        """The same without derivatives."""
        return replace(prospect, start="another size", jacobian=0.0 * prospect.jacobian)

    def fit(self, effects, near, added):
        """As of two valleys; what it begins from is kept."""
        self.begun = [*getattr(self, "begun", []), *(prospect.start for prospect in added)]
        return super().fit(effects, near, added)


def test_another_size_that_promises_too_little_is_not_fitted():
    """It could only end where the other did."""
    sets = _NoOtherValley(made_up(2), {"c": 0.05}, WHITE, 2)
    chosen(sets)
    assert sets.begun
    assert "another size" not in sets.begun


class _NoBetter(LinearSets):
    """A fit of two effects ends where the best of one has ended, to the tolerance of fits; begun: the fits in order."""

    def fit(self, effects, near, added):
        """As of sets, but for that."""
        self.begun, self.alone = [*getattr(self, "begun", []), effects], getattr(self, "alone", [])
        fitted = super().fit(effects, near, added)
        if len(effects) == 1:
            self.alone.append(fitted)
            return fitted
        return replace(fitted, residual=(1 + 1e-6) * min(self.alone, key=lambda f: f.squares).residual)


def test_a_fit_that_ends_as_well_as_a_smaller_set_is_not_repeated():
    """Where an effect adds nothing, the fit was not lost."""
    sets = _NoBetter(made_up(8), {"a": 0.05, "b": 0.05}, WHITE, 8)
    chosen(sets)
    assert any(len(effects) > 1 for effects in sets.begun)
    assert len(sets.begun) == len(set(sets.begun))


class _AlwaysLost(LinearSets):
    """A fit of two effects ends where the baseline is; begun: where each began."""

    def fit(self, effects, near, added):
        """As of sets, but for that."""
        self.begun = [*getattr(self, "begun", []), (effects, near, *added)]
        fitted = super().fit(effects, near, added)
        return replace(fitted, residual=self.baseline().residual) if len(effects) > 1 else fitted


def test_a_fit_that_was_lost_does_not_begin_once_more_where_it_began():
    """It would only end there again."""
    sets = _AlwaysLost(made_up(6), {"a": 0.05, "b": 0.03}, WHITE, 6)
    chosen(sets)
    begun = [(effects, *map(id, where)) for effects, *where in sets.begun]
    assert any(len(effects) > 1 for effects, *_ in begun)
    assert len(begun) == len(set(begun))


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


class _LookOtherwiseAtFirst(LinearSets):
    """Beside the baseline, effects look like something else: a model that is out of step shows them out of step."""

    as_they_are = frozenset("a")

    def _prospect(self, of, name):
        found = super()._prospect(of, name)
        if of.effects or name in self.as_they_are:
            return found
        other = self._centred(smooth_series(np.random.default_rng(ord(name)), self.runs)[:, None])
        return replace(found, jacobian=np.column_stack([of.jacobian, other]), looks=other)


def test_what_is_left_is_looked_at_from_where_it_is_left():
    """Beside the baseline the second one looks like nothing that the first one leaves; beside the first one it does."""
    for seed in range(3):
        sets = _LookOtherwiseAtFirst(made_up(seed), {"a": 0.3, "d": 0.05}, WHITE, seed)
        assert chosen(sets)[0] == "ad"


class _NothingShowsTheNoise(_LookOtherwiseAtFirst):
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


def test_what_may_stand_in_a_place_is_looked_at_beside_the_rest():
    """Beside the baseline the double of the chosen one looks like something else, and four others look more like it."""
    series = made_up(1)
    series["b"] = series["a"] + 0.01 * series["b"]
    sets = _LookOtherwiseAtFirst(series, {"a": 0.1, "d": 0.3}, WHITE, 1)
    begun = tuple(sets.fit(frozenset(one), sets.baseline(), ()) for one in ("ad", "d"))
    assert choose(search(sets, POLICY, begun=begun), POLICY).groups == (("a", "b"),)


class _BLooksOtherwiseAtFirst(_LookOtherwiseAtFirst):
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


class _AloneALooksOtherwise(_LookOtherwiseAtFirst):
    """What is missing looks like another effect beside the baseline, and like itself nowhere."""

    as_they_are = frozenset("bcdefghij")


def test_a_larger_set_is_left_for_its_parts_until_no_part_will_do():
    """Of three effects one is there; it was never fitted alone, nor was any two of them."""
    series = made_up(1)
    series["b"] = series["a"] + 1.5 * series["b"]
    sets = _AloneALooksOtherwise(series, {"a": 0.3}, WHITE, 1)
    begun = (sets.fit(frozenset("acd"), sets.baseline(), ()),)
    assert choose(search(sets, POLICY, begun=begun), POLICY).chosen == frozenset("a")


class _Boasts(_LookOtherwiseAtFirst):
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


class WithinReach(LinearSets):
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
    sets = WithinReach(series, {"a": 0.1, "b": 0.1}, WHITE, seed)
    assert frozenset("cd") not in search(sets, POLICY, stand_ins=False).known
    found = search(
        sets, POLICY, stand_ins=False, judges=Judged(is_law=lambda effects: effects <= frozenset("cd"))
    )
    assert choose(found, POLICY, lambda effects: effects <= frozenset("cd")).chosen == frozenset("cd")


def test_a_search_foresees_which_fits_it_will_ask_for():
    """The likeliest of those that are foreseen is asked for next, and many are foreseen."""
    foreseen = came_true = count = 0
    for seed in range(3):
        sets = LinearSets(made_up(seed), dict(zip("abcd", (0.3, 0.25, 0.2, 0.2), strict=True)), WHITE, seed)
        search(sets, POLICY)
        count += len(sets.asked) - 1
        for (_, likely), (asked, _) in pairwise(sets.asked):
            assert len(set(likely)) == len(likely)
            foreseen += bool(likely)
            came_true += likely[:1] == [asked]
    assert foreseen >= count / 3
    assert came_true >= 0.9 * foreseen
