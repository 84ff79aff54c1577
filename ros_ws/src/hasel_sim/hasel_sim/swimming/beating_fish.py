"""A fish whose tail is seen to beat: how fast the forces of the fluid make it, and what its head's drag must be."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from hasel_common.yaml_text import read_yaml
from scipy.optimize import brentq

from hasel_sim.effects.base import ForceEffect, Surroundings
from hasel_sim.effects.registry import find_effects
from hasel_sim.errors import SimulationError
from hasel_sim.swimming.given_shape import Shape, Swimmer, swim

POWERS = np.array([2, 3, 4])
"""Of s, 0 at the base of the tail to 1 at the last marker, in the deflection of the tail."""
_FORCES = Path(__file__).with_name("fish_in_water.yaml")
_DRAGS = (0.0, 3.0)
"""Form drags [1] among which the right one is sought."""


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
