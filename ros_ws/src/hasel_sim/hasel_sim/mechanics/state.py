# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Motion, drive and state of the bodies in all lanes, what is kept of their way, and loops over nodal arrays."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import TypeVar

import numpy as np
from numba import njit

from hasel_sim.simd import LaneTuple, Value, four, load, of_lane, store, with_lane, zero

Fields = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Position, velocity and acceleration of the nodes as the compiled loops take them."""


@dataclass(frozen=True)
class DriveState:
    """Drive (voltage [V], pressure [Pa] ...) and contraction [1] of every muscle [muscles, lanes], time [s] [lanes].

    Of a series of steps, the same with the steps as the first axis.
    """

    voltage: np.ndarray
    contraction: np.ndarray
    time: np.ndarray

    @staticmethod
    def single(voltage: np.ndarray, contraction: np.ndarray, time: float) -> "DriveState":
        """That of one lane, from voltage and contraction [muscles]."""
        return DriveState(np.asarray(voltage)[:, None], np.asarray(contraction)[:, None], np.array([time]))

    @staticmethod
    def beside(each: Sequence["DriveState"]) -> "DriveState":
        """Those of several lanes."""
        names = ("voltage", "contraction", "time")
        return DriveState(*(np.concatenate([getattr(d, name) for d in each], axis=-1) for name in names))

    @property
    def signals(self) -> np.ndarray:
        """A zero, the contraction and the drive of every muscle, and the time, [2 + 2 muscles, lanes]."""
        time = self.time[..., None, :]
        return np.concatenate([np.zeros_like(time), self.contraction, self.voltage, time], axis=-2)

    def at(self, step: int) -> "DriveState":
        """That of one step of a series."""
        return DriveState(self.voltage[step], self.contraction[step], self.time[step])

    def of_lane(self, lane: int) -> dict[str, np.ndarray | float]:
        """Voltage [muscles], contraction [muscles] and time of one lane, by name."""
        return {
            "voltage": self.voltage[:, lane],
            "contraction": self.contraction[:, lane],
            "time": float(self.time[lane]),
        }


@dataclass(frozen=True)
class Motion:
    """Nodal positions [m], velocities [m/s] and accelerations [m/s^2], each [nodes, 2, lanes]."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray

    @staticmethod
    def at_rest(position: np.ndarray) -> "Motion":
        """Nothing moves."""
        still = np.zeros_like(position)
        return Motion(position, still, still)

    @property
    def fields(self) -> Fields:
        """All three as the compiled loops take them."""
        x, v, a = map(np.ascontiguousarray, (self.position, self.velocity, self.acceleration))
        return x, v, a


@dataclass(frozen=True)
class Memory:
    """What the internal branches carry over a step: their history [elements, points, 3, lanes], the time since [s]."""

    history: np.ndarray | None = None
    step: float | np.ndarray | Sequence[float] = 0.0


_Own = TypeVar("_Own", bound="State")


@dataclass
class State:
    """Positions [m], velocities [m/s], accelerations [m/s^2] [nodes, 2, lanes].

    branch: stresses of the internal branches [Pa] [branches, elements, points, 3, lanes], None where there are none;
    green: C : E [Pa] at this state's strain [elements, points, 3, lanes], likewise.
    """

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    branch: np.ndarray | None = None
    green: np.ndarray | None = None

    @property
    def motion(self) -> Motion:
        """Its motion."""
        return Motion(self.position, self.velocity, self.acceleration)

    def _each(self: _Own, of_array: Callable[[np.ndarray], np.ndarray]) -> _Own:
        return type(self)(*(None if array is None else of_array(array) for array in vars(self).values()))

    def lane(self: _Own, index: int) -> _Own:
        """What belongs to one lane, as arrays of their own."""
        return self._each(lambda array: array[..., index : index + 1].copy())

    def copy(self: _Own) -> _Own:
        """The same in arrays of their own."""
        return self._each(np.copy)

    def zeros(self: _Own) -> _Own:
        """Zeros in the same shape."""
        return self._each(np.zeros_like)

    def put(self, lanes: int | np.ndarray, other: "State", place: int | np.ndarray = 0) -> None:
        """Take over the lanes of another, from these places in it."""
        for name, own in vars(self).items():
            if own is not None:
                own[..., lanes] = getattr(other, name)[..., place]

    @classmethod
    def beside(cls: type[_Own], each: Sequence[_Own]) -> _Own:
        """Several, one lane after the other."""
        arrays = ([getattr(one, field.name) for one in each] for field in fields(cls))
        return cls(*(None if a[0] is None else np.concatenate(a, axis=-1) for a in arrays))


class StateSlopes(State):
    """Derivatives of a `State` by parameters: the same arrays with a leading axis of columns."""


@dataclass(frozen=True)
class NodeTrajectories:
    """Positions [m] of the nodes around the markers, and where asked for of all nodes.

    nodes: around the markers [markers, 8]; local: their positions [boundaries, markers, 8, 2, lanes]; slopes: what
    these change [boundaries, columns, markers, 8, 2, lanes]; shapes: all positions [boundaries, nodes, 2, lanes], or an
    empty first axis.
    """

    nodes: np.ndarray
    local: np.ndarray
    slopes: np.ndarray
    shapes: np.ndarray

    @staticmethod
    def of(
        nodes: np.ndarray, boundaries: int, state: State, columns: int, keep_shapes: bool
    ) -> "NodeTrajectories":
        """Room for so many boundaries and columns of derivatives."""
        place = (*nodes.shape, 2, state.position.shape[-1])
        shapes = np.zeros((boundaries if keep_shapes else 0, *state.position.shape))
        return NodeTrajectories(
            nodes, np.zeros((boundaries, *place)), np.zeros((boundaries, columns, *place)), shapes
        )

    def note(self, boundary: int, state: State, slopes: StateSlopes) -> None:
        """Keep where the nodes are at a boundary between steps."""
        self.local[boundary] = state.position[self.nodes]
        if len(self.shapes):
            self.shapes[boundary] = state.position
        if self.slopes.shape[1]:
            np.take(slopes.position, self.nodes, axis=1, out=self.slopes[boundary])


@njit(inline="always")
def chosen_of(new: Value, old: Value, chosen: np.ndarray, lane: LaneTuple) -> Value:
    """New numbers in the lanes chosen [lanes], old ones in the others."""
    for k in range(len(lane)):
        if not chosen[k]:
            new = with_lane(new, k, of_lane(old, k))
    return new


@njit(cache=True, fastmath=True, error_model="numpy")
def copy_lanes(source: np.ndarray, to: np.ndarray, chosen: np.ndarray, lane: LaneTuple) -> None:
    """Copy the lanes chosen [lanes]."""
    for at in range(0, to.size, len(lane)):
        store(to, at, chosen_of(load(source, at, lane), load(to, at, lane), chosen, lane))


@njit(cache=True, fastmath=True, error_model="numpy")
def subtract_lanes(change: np.ndarray, out: np.ndarray, chosen: np.ndarray, lane: LaneTuple) -> None:
    """Subtract the beginning of an array from another in the lanes chosen [lanes]."""
    for at in range(0, out.size, len(lane)):
        step = chosen_of(load(change, at, lane), zero(lane), chosen, lane)
        store(out, at, load(out, at, lane) - step)


@njit(cache=True, fastmath=True, error_model="numpy")
def difference(more: np.ndarray, less: np.ndarray, out: np.ndarray, lane: LaneTuple) -> None:
    """The difference of two arrays at the beginning of another, zeros behind it."""
    for at in range(0, out.size, len(lane)):
        if at < more.size:
            store(out, at, load(more, at, lane) - load(less, at, lane))
        else:
            store(out, at, zero(lane))


@njit(cache=True, fastmath=True, error_model="numpy")
def combine(
    position: np.ndarray,
    velocity: np.ndarray,
    acceleration: np.ndarray,
    new: np.ndarray,
    weights: np.ndarray,
    x: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Weighted sums of nodal vectors [nodes, 2, lanes], as a time step needs them, into x, v and a.

    weights [8, lanes]: of the velocity, acceleration and new acceleration in x; of the two accelerations in v and in a;
    one more is not used.
    """
    lanes = len(lane)
    xv, xa, xn, va = four(weights, 0, lane)
    vn, aa, an, _ = four(weights, 4 * lanes, lane)
    for at in range(0, position.size, lanes):
        speed, old, now = load(velocity, at, lane), load(acceleration, at, lane), load(new, at, lane)
        store(x, at, load(position, at, lane) + xv * speed + xa * old + xn * now)
        store(v, at, speed + va * old + vn * now)
        store(a, at, aa * old + an * now)
