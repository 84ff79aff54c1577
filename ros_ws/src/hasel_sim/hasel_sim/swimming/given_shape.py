"""A swimmer whose changing shape is given and whose way through the fluid is sought.

The shape is known in a frame of the body; how that frame moves and turns follows from the effects of the fluid, which
are those of the catalogue, and from the body's inertia: three equations of motion (the recoil problem; Lighthill,
Proceedings of the Royal Society B 179 (1971) 125, section 3).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
from scipy.integrate import solve_ivp

from hasel_sim.effects.base import ForceEffect, SiteState, Surroundings
from hasel_sim.errors import SimulationError


@dataclass(frozen=True)
class Shape:
    """A centre line at one instant in the body's frame, at n places from nose to tail, the last at the tail's end.

    position [m], velocity [m/s], acceleration [m/s^2], and the derivatives along the line of position (tangent [1]) and
    velocity (tangent_rate [1/s]), all [n, 2].
    """

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    tangent: np.ndarray
    tangent_rate: np.ndarray


@dataclass(frozen=True)
class Swimmer:
    """lengths: what each place stands for [m] [n], 0 at the tail's end; mass: per place and depth [kg/m] [n].

    shape: at a time [s]; effects: with the values of their parameters.
    """

    lengths: np.ndarray
    mass: np.ndarray
    shape: Callable[[float], Shape]
    effects: Sequence[tuple[ForceEffect, dict[str, float]]]
    surroundings: Surroundings


@dataclass(frozen=True)
class Way:
    """Where the body's frame is [m] [n, 2], how far it is turned [rad] [n], its velocity [m/s] [n, 2]; at times [s]."""

    time: np.ndarray
    place: np.ndarray
    turned: np.ndarray
    velocity: np.ndarray

    def mean_velocity(self, start: float, end: float) -> np.ndarray:
        """Displacement between two times over the time between them [m/s], [2]."""
        x, y = (np.interp([start, end], self.time, self.place[:, axis]) for axis in range(2))
        return np.array([np.ptp(x) * np.sign(x[1] - x[0]), np.ptp(y) * np.sign(y[1] - y[0])]) / (end - start)


def swim(
    swimmer: Swimmer, times: np.ndarray, velocity: Sequence[float] = (0.0, 0.0), held: Sequence[int] = ()
) -> Way:
    """The way from rest, or from a velocity [m/s] [2], at times [s] [n].

    held: directions of motion that something prevents, of 0 (along x), 1 (along y) and 2 (turning). Raises
    SimulationError where it cannot be followed.
    """
    free = [direction for direction in range(3) if direction not in held]

    def rate(time: float, state: np.ndarray) -> np.ndarray:
        acceleration = np.zeros(3)
        acceleration[free] = _acceleration(swimmer, time, state, free)
        return np.concatenate([state[3:], acceleration])

    start = np.array([0.0, 0.0, 0.0, *velocity, 0.0])
    found = solve_ivp(rate, (times[0], times[-1]), start, method="LSODA", t_eval=times, rtol=1e-6, atol=1e-9)
    if not found.success:
        raise SimulationError(
            f"the given shape cannot be followed ({found.message}); expected one that is smooth"
        )
    return Way(times, found.y[:2].T, found.y[2], found.y[3:5].T)


def _acceleration(swimmer: Swimmer, time: float, state: np.ndarray, free: list[int]) -> np.ndarray:
    """Acceleration of the frame (x, y, turning) in its free directions: forces out of balance are affine in it."""
    rest = out_of_balance(swimmer, time, state, np.zeros(3))[free]
    columns = [out_of_balance(swimmer, time, state, unit)[free] - rest for unit in np.eye(3)[free]]
    return -np.linalg.solve(np.stack(columns, axis=1), rest)


def out_of_balance(swimmer: Swimmer, time: float, state: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
    """Inertia less the forces of the fluid, per depth: along x, along y [N/m] and about the frame's origin [N], [3].

    state: x, y [m], turned [rad] and their rates; acceleration: the rates' rates.
    """
    shape, turn, spin = swimmer.shape(time), state[2], state[5]
    to_world = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    arm, slip, push = (part @ to_world for part in (shape.position, shape.velocity, shape.acceleration))
    tangent, bending = shape.tangent @ to_world, shape.tangent_rate @ to_world
    around, across = _turned(arm), _turned(tangent)
    moved = acceleration[:2] + acceleration[2] * around - spin**2 * arm + 2 * spin * _turned(slip) + push
    at = _sites(
        swimmer, arm, state[3:5] + spin * around + slip, moved, tangent, spin * across + bending, time
    )
    directions = np.zeros((3, 2, *arm.shape))
    directions[0, 0, :, 0] = directions[1, 0, :, 1] = 1.0
    directions[2] = around, across
    inertia = swimmer.mass[:, None] * moved
    out = np.einsum("cni,ni->c", directions[:, 0], inertia)
    for effect, values in swimmer.effects:
        p = SimpleNamespace(**{**effect.null(), **values})
        force = swimmer.lengths[:, None] * effect.force(at, p)
        out -= np.einsum("cni,ni->c", directions[:, 0], force)
        if effect.has_flux:
            flux = effect.flux(at, p)
            out -= np.einsum("ci,i->c", directions[:, 0, -1], flux[-1])
            out += np.einsum("cni,ni->c", directions[:, 1], swimmer.lengths[:, None] * flux)
    return out


def _turned(vectors: np.ndarray) -> np.ndarray:
    """Vectors [n, 2] turned to the left by a right angle."""
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)


def _sites(
    swimmer: Swimmer, position, velocity, acceleration, tangent, tangent_rate, time: float
) -> SiteState:
    nothing = np.zeros(0)
    return SiteState(
        position=position,
        velocity=velocity,
        acceleration=acceleration,
        tangent=tangent,
        tangent_rate=tangent_rate,
        reference=position,
        rest_normal=np.zeros_like(position),
        measure=swimmer.lengths,
        voltage=nothing,
        contraction=nothing,
        time=time,
        gravity=np.zeros(2),
        surroundings=swimmer.surroundings,
    )
