# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A swimmer whose changing shape is given and whose way through the fluid is sought, such as a fish seen to beat.

The shape is known in a frame of the body; how that frame moves and turns follows from the effects of the fluid, which
are those of the catalogue, and from the body's inertia: three equations of motion (the recoil problem; Lighthill,
Proceedings of the Royal Society B 179 (1971) 125, section 3). How fast the forces of the fluid make a fish tells what
its head's drag must be.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from hasel_common.yaml_text import read_yaml
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from hasel_sim.effects.base import ForceEffect, SiteState, Surroundings
from hasel_sim.effects.registry import find_effects
from hasel_sim.errors import SimulationError

POWERS = np.array([2, 3, 4])
"""Of s, 0 at the base of the tail to 1 at the last marker, in the deflection of the tail."""
_FORCES = Path(__file__).with_name("fish_in_water.yaml")
_DRAGS = (0.0, 3.0)
"""Form drags [1] among which the right one is sought."""


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
    many, nothing = (len(tried), 1), np.zeros(0)
    place = np.tile(arm, many)
    at = SiteState(
        position=place,
        velocity=np.tile(state[3:5] + spin * around + slip, many),
        acceleration=moved.reshape(-1, 2),
        tangent=np.tile(tangent, many),
        tangent_rate=np.tile(spin * across + bending, many),
        reference=place,
        rest_normal=np.zeros_like(place),
        measure=np.tile(swimmer.lengths, len(tried)),
        voltage=nothing,
        contraction=nothing,
        time=time,
        gravity=np.zeros(2),
        surroundings=swimmer.surroundings,
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


@dataclass(frozen=True)
class Fish:
    """nose, tail_base: places along the head's axis [m]; depth [m]; mass [kg]; density [kg/m^3] and viscosity [Pa s].

    beat: deflection over that of the last marker, complex coefficients of s to the powers 2, 3 and 4.
    """

    nose: float
    tail_base: float
    beat: np.ndarray
    depth: float
    mass: float
    density: float = 998.0
    viscosity: float = 1.0e-3


@dataclass(frozen=True)
class Beat:
    """How a tail beats: frequency [Hz], amplitude across and place along the head's axis of its last marker [m].

    speed: what the fish was seen to swim at [m/s].
    """

    frequency: float
    amplitude: float
    place: float
    speed: float


def beat_shape(s: np.ndarray, deflection: np.ndarray) -> np.ndarray:
    """Coefficients of `Fish.beat` from deflections over the last marker's, complex [n], at s [n], by least squares."""
    return np.linalg.lstsq((s[:, None] ** POWERS).astype(complex), deflection, rcond=None)[0]


def swimmer(fish: Fish, beat: Beat, form_drag: float, points: int = 32) -> Swimmer:
    """The fish as it beats, in its fluid."""
    places, weights = np.polynomial.legendre.leggauss(points)
    length = beat.place - fish.nose
    x = np.append(fish.nose + 0.5 * length * (1 + places), beat.place)
    lengths = np.append(0.5 * length * weights, 0.0)
    s = np.clip((x - fish.tail_base) / (beat.place - fish.tail_base), 0.0, None)
    powers = POWERS[:, None]
    deflection = beat.amplitude * fish.beat @ s**powers
    slope = beat.amplitude * fish.beat @ (powers * s ** (powers - 1)) / (beat.place - fish.tail_base)
    omega = 2 * np.pi * beat.frequency

    def shape(time: float) -> Shape:
        turn = np.exp(1j * omega * time)

        def across(values: np.ndarray, along: np.ndarray | float = 0.0) -> np.ndarray:
            return np.stack([np.broadcast_to(along, x.shape), (values * turn).real], axis=1)

        return Shape(
            across(deflection, x),
            across(1j * omega * deflection),
            across(-(omega**2) * deflection),
            across(slope, 1.0),
            across(1j * omega * slope),
        )

    effects = _forces(form_drag)
    around = Surroundings(fish.density, fish.viscosity, fish.depth, length)
    return Swimmer(lengths, fish.mass / fish.depth * lengths / length, shape, effects, around)


@cache
def _coefficients() -> tuple[tuple[ForceEffect, dict[str, float | str]], ...]:
    """The forces of the water and their coefficients, "fitted" for the one that is."""
    values = read_yaml(_FORCES.read_text(encoding="utf-8"))["effects"]
    found = zip(find_effects(tuple(values)), values.values(), strict=True)
    return tuple((effect, own) for effect, own in found if isinstance(effect, ForceEffect))


def _forces(form_drag: float) -> list[tuple[ForceEffect, dict[str, float]]]:
    """The forces of the water and their coefficients."""
    return [
        (effect, {name: form_drag if value == "fitted" else float(value) for name, value in own.items()})
        for effect, own in _coefficients()
    ]


def settled_speed(fish: Fish, beat: Beat, form_drag: float, periods: int = 5) -> float:
    """Speed forwards [m/s] over the last two of so many beats, from the measured one on."""
    steps = 24
    times = np.linspace(0.0, periods / beat.frequency, steps * periods + 1)
    way = swim(swimmer(fish, beat, form_drag), times, (-beat.speed, 0.0), tolerance=1e-4)
    late = slice(-2 * steps - 1, None)
    ahead = -np.array([np.cos(way.turned[late].mean()), np.sin(way.turned[late].mean())])
    return float(way.mean_velocity(times[-2 * steps - 1], times[-1]) @ ahead)


def fitted_form_drag(fish: Fish, beats: Sequence[Beat]) -> float:
    """The drag of the head [1] with which these speeds are met in the mean.

    Raises SimulationError where none within 0 to 3 does.
    """

    def excess(drag: float) -> float:
        return sum(settled_speed(fish, beat, drag) - beat.speed for beat in beats)

    low, high = (excess(drag) for drag in _DRAGS)
    if low * high > 0:
        raise SimulationError(
            f"no form drag between {_DRAGS[0]:g} and {_DRAGS[1]:g} makes the fish as fast as it was, {low:+.3g} and "
            f"{high:+.3g} m/s at these; expected one that does: look at its depth, mass and beat"
        )
    return float(brentq(excess, *_DRAGS, xtol=0.005))
