"""What force and stress effects share: one call for all lanes with the same values, unless it looks at the drive."""

import dataclasses
from collections.abc import Callable, Iterable, Mapping, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from hasel_common.names import nearest_name

from hasel_sim.effects.base import Effect

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
    groups: Groups,
    shape: tuple[int, ...],
    ask: Callable[[np.ndarray, SimpleNamespace], np.ndarray | None],
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


def by_point(rows: np.ndarray) -> np.ndarray:
    """Rows of the points of every lane [lanes, n, k], as [n, k, lanes]."""
    return np.ascontiguousarray(rows.transpose(1, 2, 0))


def repeated(rows: np.ndarray, copies: int) -> np.ndarray:
    """Rows [n, ...] as often as asked, one copy after the other, [copies n, ...]."""
    out = np.empty((copies, *rows.shape), dtype=rows.dtype)
    out[:] = rows
    return out.reshape(-1, *rows.shape[1:])
