"""Choices among sets of made-up effects, without a simulator."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from hasel_sysid.noise import NoiseModel
from hasel_sysid.selection import POLICY, choose, search
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


class LookOtherwiseAtFirst(LinearSets):
    """Beside the baseline, effects look like something else: a model that is out of step shows them out of step."""

    as_they_are = frozenset("a")

    def _prospect(self, of, name):
        found = super()._prospect(of, name)
        if of.effects or name in self.as_they_are:
            return found
        other = self._centred(smooth_series(np.random.default_rng(ord(name)), self.runs)[:, None])
        return replace(found, jacobian=np.column_stack([of.jacobian, other]), looks=other)
