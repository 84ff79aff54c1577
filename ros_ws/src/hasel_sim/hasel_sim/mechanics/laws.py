"""What force and stress effects share: one call for all lanes with the same values, unless it looks at the drive."""

from collections.abc import Callable, Sequence
from types import SimpleNamespace

import numpy as np

_OF_THE_DRIVE = ("voltage", "contraction", "time")


def grouped(values: Sequence[SimpleNamespace | None]) -> list[tuple[np.ndarray, SimpleNamespace]]:
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


def one_by_one(groups: list[tuple[np.ndarray, SimpleNamespace]]) -> list[tuple[np.ndarray, SimpleNamespace]]:
    """Every lane a group of its own."""
    return [(lanes[n : n + 1], own) for lanes, own in groups for n in range(len(lanes))]


def watched(kind: type, names: Sequence[str] = _OF_THE_DRIVE) -> type:
    """The same class of points, whose objects note in `looked` whether one of these attributes was asked for.

    Only a lane's own drive is right for its points; lanes go into one call as long as nobody looks at it.
    """

    class Watched(kind):
        looked = False

        def __getattribute__(self, name: str):
            if name in names:
                object.__getattribute__(self, "__dict__")["looked"] = True
            return object.__getattribute__(self, name)

    return Watched


def by_group(
    groups: list[tuple[np.ndarray, SimpleNamespace]],
    fields: dict[str, np.ndarray],
    call: Callable[[dict[str, np.ndarray], np.ndarray, SimpleNamespace], np.ndarray],
) -> np.ndarray:
    """What an effect returns for fields [copies, n, k, lanes], in the same shape; zero in lanes of no group.

    call: from fields [copies lanes n, k], the lanes and their values, to an array like the fields.
    """
    shape = next(iter(fields.values())).shape
    out = np.zeros(shape)
    for lanes, values in groups:
        everyone = len(lanes) == shape[-1]
        rows = {
            name: (field if everyone else field[..., lanes]).transpose(0, 3, 1, 2).reshape(-1, shape[2])
            for name, field in fields.items()
        }
        found = call(rows, lanes, values).reshape(shape[0], len(lanes), *shape[1:3])
        if everyone:
            return np.ascontiguousarray(found.transpose(0, 2, 3, 1))
        out[..., lanes] = found.transpose(0, 2, 3, 1)
    return out


def repeated(rows: np.ndarray, copies: int) -> np.ndarray:
    """Rows [n, ...] as often as asked, one copy after the other, [copies n, ...]."""
    out = np.empty((copies, *rows.shape), dtype=rows.dtype)
    out[:] = rows
    return out.reshape(-1, *rows.shape[1:])
