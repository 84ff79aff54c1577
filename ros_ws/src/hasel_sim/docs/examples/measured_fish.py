"""Speeds of a measured robot fish, from how its tail was seen to beat.

The fish, its films and its markers are those of srl-ethz/fishsim on GitHub (MIT licence, Soft Robotics Lab, ETH Zürich;
arXiv 2602.23283): half a metre long, driven by a motor and tendons in water. Quoted are, of its eight runs: the
frequency in the file's name, that at which the tail beats (a sine fitted to the last marker), the amplitude of that
marker across and its place along the head's axis, and the speed (a line fitted to the head). The shape of the beat is
one complex polynomial for all runs, fitted to the four in which all markers are told apart.

The shape being given, the forces of the fluid decide the speed. Added mass, cross-flow drag and skin friction are
those of theory; the one number that no theory gives, the drag of the blunt head, is fitted to two runs, and the six
others are predicted. The depth is the tail's height in the public model; the mass is estimated from its shape.

    python measured_fish.py
"""

from dataclasses import dataclass

import numpy as np
from hasel_sim.effects.base import ForceEffect, Surroundings
from hasel_sim.effects.registry import find_effects
from hasel_sim.swimming.given_shape import Shape, Swimmer, swim
from scipy.optimize import brentq

NOSE, TAIL_BASE = -0.071, 0.27
"""Places along the head's axis [m], from the middle between the two head markers: front marker, first hinge."""
BEAT = np.array([2.183 + 2.021j, -1.482 - 3.641j, 0.299 + 1.621j])
"""Deflection over the last marker's: of s^2, s^3, s^4, s from 0 at the first hinge to 1 at that marker."""
DEPTH, MASS = 0.1, 1.6
"""Of the fish, m and kg: tail height in the public model, and estimated from its shape."""
FITTED = (1.0, 1.75)
"""The runs that the drag of the head is fitted to, by their named frequency [Hz]."""
PUBLISHED = {"ellipsoids, five coefficients": 0.019, "elongated-body theory, two coefficients": 0.134}
"""Mean speed errors [m/s] in the fish's publication."""


@dataclass(frozen=True)
class MeasuredRun:
    """Frequency named and seen [Hz], amplitude and place of the last marker [m], speed [m/s]."""

    named: float
    frequency: float
    amplitude: float
    place: float
    speed: float


RUNS = (
    MeasuredRun(0.50, 0.376, 0.1005, 0.456, 0.0229),
    MeasuredRun(0.75, 0.562, 0.1050, 0.487, 0.0502),
    MeasuredRun(1.00, 0.750, 0.1101, 0.498, 0.0809),
    MeasuredRun(1.25, 0.940, 0.1060, 0.480, 0.1049),
    MeasuredRun(1.50, 1.128, 0.0995, 0.459, 0.1298),
    MeasuredRun(1.75, 1.312, 0.1051, 0.485, 0.1613),
    MeasuredRun(2.00, 1.500, 0.1024, 0.487, 0.2021),
    MeasuredRun(2.25, 1.660, 0.0983, 0.495, 0.2232),
)


def fish(run: MeasuredRun, form_drag: float, points: int = 32) -> Swimmer:
    """The fish of a run with a drag of its head."""
    places, weights = np.polynomial.legendre.leggauss(points)
    length = run.place - NOSE
    x = np.append(NOSE + 0.5 * length * (1 + places), run.place)
    lengths = np.append(0.5 * length * weights, 0.0)
    s = np.clip((x - TAIL_BASE) / (run.place - TAIL_BASE), 0.0, None)
    powers = np.array([2, 3, 4])[:, None]
    beat = run.amplitude * BEAT @ s**powers
    slope = run.amplitude * BEAT @ (powers * s ** (powers - 1)) / (run.place - TAIL_BASE)
    omega = 2 * np.pi * run.frequency

    def shape(time: float) -> Shape:
        turn = np.exp(1j * omega * time)

        def across(values: np.ndarray, along: np.ndarray | float = 0.0) -> np.ndarray:
            return np.stack([np.broadcast_to(along, x.shape), (values * turn).real], axis=1)

        return Shape(
            across(beat, x), across(1j * omega * beat), across(-(omega**2) * beat),
            across(slope, 1.0), across(1j * omega * slope),
        )  # fmt: skip

    names = ("form_drag", "normal_drag", "skin_friction", "reactive_force")
    values: tuple[dict[str, float], ...] = (
        {"coefficient": form_drag},
        {"coefficient": 2.0, "boundary_layer": 4.0},
        {"along": 1.0, "thinning": 2.7},
        {"coefficient": 1.0},
    )
    water = Surroundings(998.0, 1.0e-3, DEPTH, length)
    pairs = zip(find_effects(names), values, strict=True)
    effects = [(effect, own) for effect, own in pairs if isinstance(effect, ForceEffect)]
    return Swimmer(lengths, MASS / DEPTH * lengths / length, shape, effects, water)


def speed(run: MeasuredRun, form_drag: float, periods: int = 5) -> float:
    """Settled speed forwards [m/s], from the measured one on."""
    steps = 24
    times = np.linspace(0.0, periods / run.frequency, steps * periods + 1)
    way = swim(fish(run, form_drag), times, (-run.speed, 0.0), tolerance=1e-4)
    late = slice(-2 * steps - 1, None)
    ahead = -np.array([np.cos(way.turned[late].mean()), np.sin(way.turned[late].mean())])
    return float(way.mean_velocity(times[-2 * steps - 1], times[-1]) @ ahead)


def fitted_drag() -> float:
    """The drag of the head with which the two runs are met in the mean."""
    chosen = [run for run in RUNS if run.named in FITTED]

    def excess(drag: float) -> float:
        return sum(speed(run, drag) - run.speed for run in chosen)

    return float(brentq(excess, 0.15, 1.0, xtol=0.005))


def main() -> None:
    """Print the measured and the predicted speeds."""
    drag = fitted_drag()
    print(f"drag of the head C_t = {drag:.2f}, fitted to the runs named {FITTED[0]:g} and {FITTED[1]:g} Hz")
    print("named Hz  tail Hz  ratio  measured m/s  simulated m/s")
    errors = []
    for run in RUNS:
        found = speed(run, drag)
        errors.append(abs(found - run.speed))
        seen = f"{run.named:8.2f}{run.frequency:9.3f}{run.frequency / run.named:7.2f}{run.speed:14.4f}{found:15.4f}"
        print(seen + ("  fitted" if run.named in FITTED else ""))
    unseen = [error for error, run in zip(errors, RUNS, strict=True) if run.named not in FITTED]
    print(
        f"mean |error| {np.mean(errors):.3f} m/s, {np.mean(unseen):.3f} m/s on the six that were not fitted"
    )
    for name, error in PUBLISHED.items():
        print(f"published for {name}: {error:.3f} m/s")


if __name__ == "__main__":
    main()
