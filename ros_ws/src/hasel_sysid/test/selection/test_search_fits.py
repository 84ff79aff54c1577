"""From where a search fits its sets, which fits it repeats, and which it leaves."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sysid.testing.linear_choice import WHITE, chosen, made_up
from hasel_sysid.testing.linear_sets import LinearSets


class _LostOnTheWay(LinearSets):
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
    sets = _LostOnTheWay(series, {"a": 0.05, "b": 0.05}, WHITE, 8)
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
