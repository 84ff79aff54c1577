# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Find when to switch each muscle on and off so that the swimmer bends most at a given frequency.

The voltage is 5.5 kV or nothing; free are the instants at which each muscle is switched on and off, as shares of the
period. The gradient of the angle by the whole activation series comes from one adjoint sweep, whatever the number of
steps; the drive turns it into a gradient by the four switching instants.

    python optimise_waveform.py
"""

from dataclasses import dataclass

import numpy as np
import torch
from hasel_sim.adjoint import DifferentiableRun
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import Model, load_model
from hasel_sim.run import Run
from scipy.optimize import minimize

VOLTAGE = 5500.0
PERIODS = 3
START = np.array([0.05, 0.25, 0.35, 0.25])
"""Upper muscle: on at, for; lower muscle: on at, for (shares of the period)."""
BOX = np.array([0.0, 0.5, 0.5, 0.5])
"""Alternating boxes, as in the recordings."""


@dataclass(frozen=True)
class BestWaveform:
    """switching: as START; angles: standard deviation of sin theta over the last period."""

    frequency: float
    switching: np.ndarray
    angle_before: float
    angle_after: float
    angle_box: float
    evaluations: int

    def __str__(self) -> str:
        upper, upper_for, lower, lower_for = self.switching
        return (
            f"At {self.frequency:g} Hz the swing of sin theta rises from {self.angle_before:.4f} to "
            f"{self.angle_after:.4f} in {self.evaluations} gradients: upper muscle on at {upper:.2f} for "
            f"{upper_for:.2f} of the period, lower at {lower:.2f} for {lower_for:.2f} (alternating boxes: "
            f"{self.angle_box:.4f})."
        )


def swimmer() -> Model:
    """The default swimmer with the amplitude and slope of a fitted one, on a coarse mesh."""
    model = load_model("swimmer").with_levels(np.array([VOLTAGE])).with_numerics(mesh_density=0.5)
    return model.with_values({f"amplitude_{VOLTAGE:g}": 0.0624, "slope": 0.264})


def schedule(switching: np.ndarray, frequency: float) -> DriveSchedule:
    """Voltages of both muscles over all periods; instants wrap around the period."""
    starts, lengths = switching[0::2], switching[1::2]
    events = [
        (max(period + start + share, 0.0) / frequency, muscle, VOLTAGE * (share == 0.0))
        for period in range(-1, PERIODS)
        for muscle, (start, length) in enumerate(zip(starts, lengths, strict=True))
        for share in (0.0, length)
        if period + start + length > 0
    ]
    state, rows = np.zeros(2), []
    for time, muscle, voltage in sorted(events):
        state[muscle] = voltage
        rows.append((time, *state))
    table = np.array(rows)
    return DriveSchedule(table[:, 0], table[:, 1:])


def optimise(frequency: float, evaluations: int = 20) -> BestWaveform:
    """Maximise the standard deviation of sin theta over the last period."""
    frames = np.arange(round(120 * PERIODS / frequency) + 1) / 120
    run = DifferentiableRun(swimmer(), Run("waveform", frames, schedule(START, frequency)))
    last = torch.from_numpy(frames > (PERIODS - 1) / frequency)

    def loss(switching: np.ndarray) -> tuple[float, np.ndarray]:
        waveform = torch.tensor(switching, requires_grad=True)
        contraction = run.contraction_from(waveform, lambda numbers: schedule(numbers, frequency))
        angle = run.angle(contraction)[last].std()
        (-angle).backward()
        return -angle.item(), waveform.grad.numpy()

    bounds = [(0.0, 0.3), (0.1, 0.6), (0.3, 0.9), (0.1, 0.6)]
    found = minimize(loss, START, jac=True, bounds=bounds, method="L-BFGS-B", options={"maxfun": evaluations})
    return BestWaveform(
        frequency, found.x, -loss(START)[0], -float(found.fun), -loss(BOX)[0], int(found.nfev)
    )


if __name__ == "__main__":
    print(optimise(3.5))
