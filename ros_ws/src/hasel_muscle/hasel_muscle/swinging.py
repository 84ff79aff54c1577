# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How a load swings after every lift, and whether the muscle's law with the load's inertia says so."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from hasel_sim.muscle.muscle import Muscle
from hasel_sim.muscle.swing import HangingLoad, force_table
from hasel_sysid.estimation.covariance import scatter_between_runs
from scipy.optimize import least_squares

from hasel_muscle.bench_recording import BenchRecording

WINDOW_S = 0.5
"""After a lift for as long as this it is compared."""
_SAME = 0.01
"""Voltages no further apart than this share of the largest are one."""
_REST_S, _HELD_S = 0.3, 0.3
"""A lift is from a rest as long as this to a voltage that is held as long as this."""
_SLOWEST_SAMPLES = 200.0
"""Samples per second below which no swing is seen."""
_KEPT_S = 4e-3
"""Samples are compared this far apart."""
_FEWEST_LIFTS = 4
_UNITS = {"damping": "N s/m", "slowness": "s/m", "lag": "s"}
_START = np.array([1.0, 1.0, 0.005])
_UPPER = np.array([100.0, 100.0, 0.2])


@dataclass(frozen=True)
class Lift:
    """time [s] [n] from the switch on, measured contraction [m] [n] from the rest before, NaN where nothing was seen.

    level: voltage [V]; swinging: contraction by the law with inertia [m] [n]; settled: that of the law alone [m].
    """

    level: float
    time: np.ndarray
    measured: np.ndarray
    swinging: np.ndarray
    settled: float
    unseen: bool

    @property
    def peak(self) -> tuple[float, float]:
        """Largest contraction measured and simulated [m], where something was seen."""
        return float(np.nanmax(self.measured)), float(np.max(self.swinging[np.isfinite(self.measured)]))

    @property
    def errors(self) -> tuple[float, float]:
        """Mean |law - measurement| [m] with inertia, and of the law alone."""
        away = (self.swinging - self.measured, self.settled - self.measured)
        return float(np.nanmean(np.abs(away[0]))), float(np.nanmean(np.abs(away[1])))


@dataclass(frozen=True)
class Swinging:
    """lifts: in the order of recordings and time; values and standard_errors (from lift to lift): by name."""

    lifts: tuple[Lift, ...]
    values: dict[str, float]
    standard_errors: dict[str, float]

    def mean_error(self, unseen: bool, alone: bool = False) -> float:
        """Mean over the lifts, unseen ones or the others [m]; alone: of the law without inertia. NaN without any."""
        found = [lift.errors[int(alone)] for lift in self.lifts if lift.unseen == unseen]
        return float(np.mean(found)) if found else float("nan")

    def __str__(self) -> str:
        values = ", ".join(
            f"{name} {self.values[name]:.3g} ± {self.standard_errors[name]:.1g} {unit}"
            for name, unit in _UNITS.items()
        )
        which = product((False, True), repeat=2)
        seen, alone, unseen, unseen_alone = (f"{1e3 * self.mean_error(*each):.2f} mm" for each in which)
        others = f"; on unseen voltages {unseen}, {unseen_alone} without"
        return (
            f"In the first {WINDOW_S:g} s of {len(self.lifts)} lifts the load swings: the law with its inertia "
            f"({values}) is {seen} off, {alone} without{others if any(e.unseen for e in self.lifts) else ''}."
        )

    def to_json(self) -> dict[str, Any]:
        """Plain numbers."""
        return {
            "values": self.values,
            "standard_errors": self.standard_errors,
            "lifts": [
                {
                    "voltage_v": lift.level,
                    "unseen": lift.unseen,
                    "peak_m": lift.peak[0],
                    "simulated_peak_m": lift.peak[1],
                    "error_m": lift.errors[0],
                    "error_without_inertia_m": lift.errors[1],
                }
                for lift in self.lifts
            ],
        }


@dataclass(frozen=True)
class HeldStretch:
    """A lift in a recording: level [V], numbers of the samples that are compared, contraction at rest before [m]."""

    level: float
    samples: np.ndarray
    zero: float


def stretches_of(recording: BenchRecording) -> list[HeldStretch]:
    """Lifts from rest to a voltage that is held, where a load hangs and samples are dense enough to see it swing."""
    time, voltage = recording.time, np.abs(recording.voltage)
    step, same = float(np.median(np.diff(time))), _SAME * float(voltage.max())
    if recording.held != "load" or not 0 < step <= 1 / _SLOWEST_SAMPLES or same == 0:
        return []
    rising = np.flatnonzero((voltage[:-1] <= same) & (voltage[1:] > same)) + 1
    kept = max(1, round(_KEPT_S / step))
    found = []
    for start in rising.tolist():
        before = (time >= time[start] - _REST_S) & (time < time[start] - 1e-9)
        held = (time >= time[start] + 0.02) & (time <= time[start] + _HELD_S)
        window = np.flatnonzero((time >= time[start]) & (time <= time[start] + WINDOW_S))[::kept]
        rest = recording.contraction[before]
        if not before.any() or not held.any() or not np.isfinite(rest).any():
            continue
        level = float(np.median(voltage[held]))
        quiet = voltage[before].max() <= same and time[start] - time[0] >= _REST_S
        if quiet and np.ptp(voltage[held]) <= 2 * same and np.isfinite(recording.contraction[window]).any():
            found.append(HeldStretch(float(f"{level:.3g}"), window, float(np.nanmedian(rest))))
    return found


class _SwungRecording:
    """A recording with its lifts, and the law of the load that hangs."""

    def __init__(self, recording: BenchRecording, stretches: list[HeldStretch], muscle: Muscle) -> None:
        self.recording, self.stretches = recording, stretches
        load, largest = float(np.nanmedian(recording.load)), float(np.abs(recording.voltage).max())
        self._hanging = partial(HangingLoad, muscle, load, largest)
        self._table = force_table(muscle, load, largest)
        levels, loads = np.array([each.level for each in stretches]), np.full(len(stretches), load)
        self._settled = muscle.balanced(levels, loads, loads).tolist()

    def lifts(self, numbers: np.ndarray, unseen: Sequence[float]) -> Iterator[Lift]:
        """All lifts, by these damping, slowness and lag."""
        recording = self.recording
        hanging = self._hanging(*numbers.tolist())
        x = hanging.contraction(recording.time, recording.voltage, self._table)
        for each, alone in zip(self.stretches, self._settled, strict=True):
            time = recording.time[each.samples] - recording.time[each.samples[0]]
            measured = recording.contraction[each.samples] - each.zero
            known = any(abs(volts - each.level) <= _SAME * each.level for volts in unseen)
            yield Lift(each.level, time, measured, x[each.samples], alone, known)


def swinging(
    recordings: Sequence[BenchRecording], muscle: Muscle, unseen: Sequence[float] = ()
) -> Swinging | None:
    """Fit damping, force-velocity slope and lag to the lifts of the other voltages; None where too few are seen swing.

    muscle: with its law fitted to settled frames, which stays; unseen: voltages [V] that are not fitted.
    """
    swung = [_SwungRecording(each, found, muscle) for each in recordings if (found := stretches_of(each))]

    def lifts_by(numbers: np.ndarray) -> list[Lift]:
        return [lift for one in swung for lift in one.lifts(numbers, unseen)]

    if sum(not lift.unseen for lift in lifts_by(np.zeros(3))) < _FEWEST_LIFTS:
        return None

    def residual(x: np.ndarray) -> np.ndarray:
        fitted = [lift for lift in lifts_by(x * _START) if not lift.unseen]
        return np.concatenate([np.nan_to_num(lift.swinging - lift.measured) for lift in fitted])

    ends = 0.0, _UPPER / _START
    best = least_squares(residual, np.ones(3), bounds=ends, diff_step=1e-2, x_scale=1.0, max_nfev=40)
    numbers = best.x * _START
    lifts = lifts_by(numbers)
    fitted = [lift for lift in lifts if not lift.unseen]
    each = np.concatenate([np.full(len(lift.time), number) for number, lift in enumerate(fitted)])
    errors = scatter_between_runs(best.jac, best.fun, each) * _START
    values, scatter = (dict(zip(_UNITS, each.tolist(), strict=True)) for each in (numbers, errors))
    return Swinging(tuple(lifts), values, scatter)
