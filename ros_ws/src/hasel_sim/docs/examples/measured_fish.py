# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
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

The same from the files themselves: `ros2 run hasel_sysid measured_fish DIR`, with DIR a clone of that repository.
"""

from dataclasses import dataclass

import numpy as np
from hasel_sim.swimming.given_shape import Beat, Fish, fitted_form_drag, settled_speed

FISH = Fish(
    nose=-0.071,
    tail_base=0.27,
    beat=np.array([2.183 + 2.021j, -1.482 - 3.641j, 0.299 + 1.621j]),
    depth=0.1,
    mass=1.6,
)
"""Places along the head's axis from the middle between the two head markers: front marker, first hinge; the shape of
the beat; the depth is the tail's height in the public model, the mass is estimated from its shape."""
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

    @property
    def beat(self) -> Beat:
        """As the simulator takes it."""
        return Beat(self.frequency, self.amplitude, self.place, self.speed)


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


def speed(run: MeasuredRun, form_drag: float) -> float:
    """Settled speed forwards [m/s]."""
    return settled_speed(FISH, run.beat, form_drag)


def fitted_drag() -> float:
    """The drag of the head with which the two runs are met in the mean."""
    return fitted_form_drag(FISH, [run.beat for run in RUNS if run.named in FITTED])


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
