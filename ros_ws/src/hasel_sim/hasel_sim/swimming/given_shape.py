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
    swimmer: Swimmer,
    times: np.ndarray,
    velocity: Sequence[float] = (0.0, 0.0),
    held: Sequence[int] = (),
    tolerance: float = 1e-6,
) -> Way:
    """The way from rest, or from a velocity [m/s] [2], at times [s] [n].

    held: directions of motion that something prevents, of 0 (along x), 1 (along y) and 2 (turning); tolerance:
    relative, of the integration. Raises SimulationError where the way cannot be followed.
    """
    free = [direction for direction in range(3) if direction not in held]

    def rate(time: float, state: np.ndarray) -> np.ndarray:
        acceleration = np.zeros(3)
        acceleration[free] = _acceleration(swimmer, time, state, free)
        return np.concatenate([state[3:], acceleration])

    start = np.array([0.0, 0.0, 0.0, *velocity, 0.0])
    span = (times[0], times[-1])
    found = solve_ivp(rate, span, start, method="LSODA", t_eval=times, rtol=tolerance, atol=1e-3 * tolerance)
    if not found.success:
        raise SimulationError(
            f"the given shape cannot be followed ({found.message}); expected one that is smooth"
        )
    return Way(times, found.y[:2].T, found.y[2], found.y[3:5].T)


def _acceleration(swimmer: Swimmer, time: float, state: np.ndarray, free: list[int]) -> np.ndarray:
    """Acceleration of the frame (x, y, turning) in its free directions: forces out of balance are affine in it."""
    tried = np.concatenate([np.zeros((1, 3)), np.eye(3)[free]])
    found = out_of_balance(swimmer, time, state, tried)[:, free]
    return -np.linalg.solve((found[1:] - found[0]).T, found[0])


def out_of_balance(swimmer: Swimmer, time: float, state: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
    """Inertia less the fluid's forces, per depth: along x, along y [N/m] and about the frame's origin [N], [..., 3].

    state: x, y [m], turned [rad] and their rates; acceleration: the rates' rates, [3], or several to be tried [k, 3].
    """
    tried = np.atleast_2d(acceleration)
    shape, turn, spin = swimmer.shape(time), state[2], state[5]
    to_world = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    arm, slip, push = (part @ to_world for part in (shape.position, shape.velocity, shape.acceleration))
    tangent, bending = shape.tangent @ to_world, shape.tangent_rate @ to_world
    around, across = _turned(arm), _turned(tangent)
    moved = tried[:, None, :2] + tried[:, 2, None, None] * around
    moved = moved - spin**2 * arm + 2 * spin * _turned(slip) + push
    many = (len(tried), 1)
    at = _sites(
        swimmer,
        np.tile(arm, many),
        np.tile(state[3:5] + spin * around + slip, many),
        moved.reshape(-1, 2),
        np.tile(tangent, many),
        np.tile(spin * across + bending, many),
        time,
    )
    directions = np.zeros((3, 2, *arm.shape))
    directions[0, 0, :, 0] = directions[1, 0, :, 1] = 1.0
    directions[2] = around, across
    out = np.einsum("cni,n,kni->kc", directions[:, 0], swimmer.mass, moved)
    for effect, values in swimmer.effects:
        p = SimpleNamespace(**{**effect.null(), **values})
        force = effect.force(at, p).reshape(moved.shape)
        out -= np.einsum("cni,n,kni->kc", directions[:, 0], swimmer.lengths, force)
        if effect.has_flux:
            flux = effect.flux(at, p).reshape(moved.shape)
            if effect.sheds:
                out -= np.einsum("ci,ki->kc", directions[:, 0, -1], flux[:, -1])
            out += np.einsum("cni,n,kni->kc", directions[:, 1], swimmer.lengths, flux)
    return out.reshape(np.shape(acceleration))


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
        measure=np.tile(swimmer.lengths, len(position) // len(swimmer.lengths)),
        voltage=nothing,
        contraction=nothing,
        time=time,
        gravity=np.zeros(2),
        surroundings=swimmer.surroundings,
    )
