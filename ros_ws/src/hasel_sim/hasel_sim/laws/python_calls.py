# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Effects called as Python: once for all lanes with the same values, at copies of their points to be differentiated.

An effect that looks at the drive is called lane by lane. Whoever waits for laws that cannot be compiled is told once.
"""

import dataclasses
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from hasel_common.names import nearest_name
from numba import njit

from hasel_sim.effects.base import Effect

Pairs = tuple[np.ndarray, np.ndarray, float]
"""Copies in which each component is more and less, and the difference between the two."""


@njit(cache=True, fastmath=True, error_model="numpy")
def _in_rows(field: np.ndarray, moved: np.ndarray, step: np.ndarray, out: np.ndarray) -> None:
    """Write a field [n, k, lanes] to every copy of [copies, lanes, n, k], moved by a step in one component or none."""
    n, components, lanes = field.shape
    for c in range(len(moved)):
        for lane in range(lanes):
            for s in range(n):
                for i in range(components):
                    out[c, lane, s, i] = field[s, i, lane]
        if moved[c] >= 0:
            for lane in range(lanes):
                for s in range(n):
                    out[c, lane, s, moved[c]] += step[c]


@njit(cache=True, fastmath=True, error_model="numpy")
def _add_changes(
    found: np.ndarray, more: np.ndarray, less: np.ndarray, factor: np.ndarray, out: np.ndarray
) -> None:
    """Add what an answer [copies, lanes, n, k] changes, times a factor [lanes], to out [n, k, components, lanes].

    Component j is moved in copy more[j], and less or not at all in copy less[j].
    """
    lanes, n, k = found.shape[1:]
    for s in range(n):
        for i in range(k):
            for j in range(len(more)):
                for lane in range(lanes):
                    change = found[more[j], lane, s, i] - found[less[j], lane, s, i]
                    out[s, i, j, lane] += factor[lane] * change


class Copies:
    """Copies of a state, each moved in one component of one quantity, or as it is."""

    def __init__(self, moves: Sequence[tuple[str, int, float]], more: Mapping[str, Pairs]) -> None:
        """moves: quantity ("" for none), component and step of every copy; more: how to differentiate by each."""
        self._count, self._pairs = len(moves), more
        self._moved = {
            name: (
                np.array([component if of == name else -1 for of, component, _ in moves]),
                np.array([step for _, _, step in moves]),
            )
            for name in more
        }
        self._as_it_is = np.full(len(moves), -1), np.zeros(len(moves))

    @classmethod
    def one_sided(cls, steps: Mapping[str, float], components: int) -> "Copies":
        """The state as it is, and one copy moved up for every component of every quantity."""
        moves = [("", -1, 0.0), *((name, i, step) for name, step in steps.items() for i in range(components))]
        more = np.arange(1, len(moves)).reshape(len(steps), components)
        pairs = zip(steps, more, steps.values(), strict=True)
        return cls(moves, {name: (up, np.zeros_like(up), step) for name, up, step in pairs})

    @classmethod
    def central(cls, steps: Mapping[str, float], components: int) -> "Copies":
        """Two copies for every component of every quantity, moved up and down."""
        moves = [
            (name, i, s) for name, step in steps.items() for i in range(components) for s in (step, -step)
        ]
        more = np.arange(0, len(moves), 2).reshape(len(steps), components)
        pairs = zip(steps, more, steps.values(), strict=True)
        return cls(moves, {name: (up, up + 1, 2 * step) for name, up, step in pairs})

    def __len__(self) -> int:
        return self._count

    def rows(self, name: str, field: np.ndarray) -> np.ndarray:
        """A quantity [n, k, lanes] in every copy, [copies, lanes, n, k]."""
        n, components, lanes = field.shape
        out = np.empty((self._count, lanes, n, components))
        _in_rows(field, *self._moved.get(name, self._as_it_is), out)
        return out

    def add_derivative(self, name: str, found: np.ndarray, factor: np.ndarray, out: np.ndarray) -> None:
        """Add factor [lanes] times the derivative by a quantity to out [n, k, components, lanes].

        found: an effect's answer to the copies, [copies, lanes, n, k].
        """
        more, less, width = self._pairs[name]
        _add_changes(found, more, less, factor / width, out)


ALONE = Copies([("", -1, 0.0)], {})
"""The state as it is."""


OF_THE_DRIVE = ("voltage", "contraction", "time")


Groups = list[tuple[np.ndarray, SimpleNamespace]]
"""Lanes and the values of an effect that they share."""


def grouped(values: Sequence[SimpleNamespace | None]) -> Groups:
    """Lanes with equal values of an effect, and these values; a lane without the effect (None) is in no group."""
    groups: list[tuple[list[int], SimpleNamespace]] = []
    for lane, own in enumerate(values):
        if own is None:
            continue
        for lanes, theirs in groups:
            if own == theirs:
                lanes.append(lane)
                break
        else:
            groups.append(([lane], own))
    return [(np.array(lanes), own) for lanes, own in groups]


def around(
    effect: Effect, name: str, values: Sequence[SimpleNamespace | None]
) -> tuple[tuple[list[SimpleNamespace | None], ...], np.ndarray]:
    """The values of all lanes with a little more and a little less of a parameter, and the widths between [lanes]."""
    parameter = next(p for p in effect.parameters if p.name == name)
    points = [None if one is None else parameter.around(getattr(one.own, name)) for one in values]

    def changed(place: int) -> list[SimpleNamespace | None]:
        pairs = zip(values, points, strict=True)
        return [
            None
            if point is None
            else SimpleNamespace(
                **{**vars(one), "own": SimpleNamespace(**{**vars(one.own), name: point[place]})}
            )
            for one, point in pairs
        ]

    return (changed(0), changed(1)), np.array([1.0 if point is None else point[2] for point in points])


def one_by_one(groups: Groups) -> Groups:
    """Every lane a group of its own."""
    return [(lanes[n : n + 1], own) for lanes, own in groups for n in range(len(lanes))]


def on_demand(kind: type, of_the_drive: Sequence[str] = OF_THE_DRIVE) -> Any:
    """The same class of points, of which an attribute is made when an effect asks for it.

    `looked` tells whether it asked for what is the drive's. Only a lane's own drive is right for its points; lanes go
    into one call as long as nobody looks at it.
    """
    fields = {field.name for field in dataclasses.fields(kind)}

    class OnDemand(kind):
        def __init__(self, known: Mapping[str, Any], made: Callable[[str], Any]) -> None:
            self.__dict__.update(known, _made=made)

        def __getattr__(self, name: str) -> Any:
            if name not in fields:
                raise AttributeError(f"{kind.__name__} has no '{name}'; {nearest_name(name, fields)}")
            value = self.__dict__[name] = self._made(name)
            return value

        def asked_for(self, names: Iterable[str]) -> bool:
            """Whether any of these was made."""
            return not self.__dict__.keys().isdisjoint(names)

        @property
        def looked(self) -> bool:
            return self.asked_for(of_the_drive)

    return OnDemand


def by_group(
    groups: Groups, shape: tuple[int, ...], ask: Callable[[np.ndarray, SimpleNamespace], np.ndarray | None]
) -> np.ndarray:
    """What an effect answers at points, [copies, lanes, n, k]; zero in lanes of no group.

    ask: from the lanes of a group and their values to the answer [copies lanes n, k], or None where the lanes must be
    asked one by one.
    """
    out = np.zeros(shape)
    for lanes, values in groups:
        found = ask(lanes, values)
        if found is None:
            out[:, lanes] = by_group(one_by_one([(lanes, values)]), shape, ask)[:, lanes]
        elif len(lanes) == shape[1]:
            return np.ascontiguousarray(found, dtype=float).reshape(shape)
        else:
            out[:, lanes] = found.reshape(shape[0], len(lanes), *shape[2:])
    return out


_said: set[str] = set()


def say_once(laws: Mapping[str, str], factor: float) -> None:
    """One line for each that was not named before in this process.

    laws: names of effects, with why they are not compiled; factor: how many times as long a step takes with them.
    """
    for name, why in laws.items():
        if name not in _said:
            _said.add(name)
            print(
                f"hasel_sim: effect '{name}' runs as Python, and steps take {factor:.1f} times as long: {why}",
                file=sys.stderr,
                flush=True,
            )
