# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A load that hangs from a muscle and swings: what a bench sees between two balances.

The muscle pulls with the force of its law at the voltage and contraction of the instant, the less the faster it
shortens, T = F(V, x) (1 - v / v_0) - c v (a linear force-velocity relation, and the losses of liquid and films), and
never pushes: a load that is thrown up flies until the films are taut again. With what moves with it, it obeys
m dv/dt = T - load. At the rest length the inextensible films end a fall. The pull follows the commanded voltage with
a lag.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit

from hasel_sim.errors import SimulationError
from hasel_sim.muscle.muscle import Muscle

GRAVITY = 9.80665
_STEP = 1e-4
"""Longest time step [s], a hundredth of the shortest period that a bench shows."""
_VOLTAGES, _CONTRACTIONS = 33, 241
"""Points of the table of forces, evenly by the square of the voltage and by the contraction."""


@dataclass(frozen=True)
class HangingLoad:
    """load: weight that hangs from the muscle [N]; largest_voltage: that will be asked for [V]; damping: c [N s/m].

    slowness: 1 / v_0, of the speed at which it would pull no more [s/m]; lag: time constant of the voltage that pulls
    [s]. Half of the muscle's own mass moves with the load. Of its effects those in time (creep) are left out: they are
    slow.
    """

    muscle: Muscle
    load: float
    largest_voltage: float
    damping: float = 0.0
    slowness: float = 0.0
    lag: float = 0.0

    @property
    def mass(self) -> float:
        """What swings [kg]."""
        return self.load / GRAVITY + 0.5 * self.muscle.mass

    @cached_property
    def forces(self) -> "ForceTable":
        """The muscle's law as a table."""
        return force_table(self.muscle, self.load, self.largest_voltage)

    def contraction(
        self, time: np.ndarray, voltage: np.ndarray, forces: "ForceTable | None" = None
    ) -> np.ndarray:
        """Contraction [m] [n] from rest, at times [s] [n] of commanded voltages [V] [n], each held until the next.

        forces: a table that is known already. Raises SimulationError for a voltage beyond the largest.
        """
        asked = float(np.abs(voltage).max(initial=0.0))
        if asked > self.largest_voltage * (1 + 1e-9):
            raise SimulationError(
                f"the voltage goes to {asked:g} V; expected at most the {self.largest_voltage:g} V that the load was "
                "made for: give a larger largest_voltage"
            )
        table = self.forces if forces is None else forces
        return _swing(
            np.ascontiguousarray(time, dtype=float),
            np.ascontiguousarray(voltage, dtype=float),
            table.newtons,
            table.largest_voltage**2,
            table.largest_contraction,
            np.array([self.load, self.mass, self.damping, self.slowness, self.lag]),
            _STEP,
        )


@dataclass(frozen=True)
class ForceTable:
    """newtons: force by the square of the voltage, from 0 to the largest's, and by contraction, 0 to the largest."""

    newtons: np.ndarray
    largest_voltage: float
    largest_contraction: float


def force_table(muscle: Muscle, rest_load: float, largest_voltage: float) -> ForceTable:
    """The static law of a muscle; rest_load [N]: at which its contraction is called 0."""
    static = muscle.without_effects(*(effect.id for effect in muscle.effects if effect.in_time))
    largest = muscle.count * max(pouch.largest_contraction for _, pouch in static.populations)
    volts = largest_voltage * np.sqrt(np.linspace(0.0, 1.0, _VOLTAGES))
    x = np.linspace(0.0, largest, _CONTRACTIONS)
    pairs = np.array(np.meshgrid(volts, x, indexing="ij")).reshape(2, -1)
    force = static.force(np.zeros(pairs.shape[1]), pairs[0], pairs[1], rest_load)
    return ForceTable(force.reshape(_VOLTAGES, _CONTRACTIONS), largest_voltage, largest)


@njit(cache=True)
def _swing(
    time: np.ndarray,
    voltage: np.ndarray,
    table: np.ndarray,
    largest_square: float,
    largest_contraction: float,
    numbers: tuple[float, float, float, float, float],
    longest: float,
) -> np.ndarray:
    load, mass, damping, slowness, lag = numbers
    x, speed, volts = 0.0, 0.0, 0.0
    out = np.zeros(len(time))
    rows, columns = table.shape
    for sample in range(1, len(time)):
        span = time[sample] - time[sample - 1]
        count = int(np.ceil(span / longest - 1e-9))
        step = span / max(count, 1)
        for _ in range(count):
            if lag > 0.0:
                volts += (voltage[sample - 1] - volts) * (1.0 - np.exp(-step / lag))
            else:
                volts = voltage[sample - 1]
            a = min(volts * volts / largest_square, 1.0) * (rows - 1)
            b = x / largest_contraction * (columns - 1)
            pull = 0.0
            if b < columns - 1:
                i, j = min(int(a), rows - 2), int(b)
                p, q = a - i, b - j
                low = (1 - q) * table[i, j] + q * table[i, j + 1]
                high = (1 - q) * table[i + 1, j] + q * table[i + 1, j + 1]
                pull = (1 - p) * low + p * high
            tension = 0.0
            if pull > 0.0:
                # backward in what is lost, which may be stiff
                lost = damping + slowness * pull
                after = (speed + step * (pull - load) / mass) / (1.0 + step * lost / mass)
                tension = max(pull - lost * after, 0.0)
            speed += step * (tension - load) / mass
            x += step * speed
            if x < 0.0:
                x, speed = 0.0, 0.0
        out[sample] = x
    return out
