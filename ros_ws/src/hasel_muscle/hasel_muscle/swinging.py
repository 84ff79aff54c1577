"""How a load swings after every lift, and whether the muscle's law with the load's inertia says so."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.muscle.muscle import Muscle
from hasel_sim.muscle.swing import ForceTable, HangingLoad, force_table
from hasel_sysid.estimation.covariance import scatter_between_runs
from scipy.optimize import least_squares

from hasel_muscle.lifts import SAME, WINDOW_S, shows_swings, stretches_of
from hasel_muscle.recording import BenchRecording

_FEWEST_LIFTS = 4
_NAMES = ("damping", "slowness", "lag")
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
            f"{name} {self.values[name]:.3g} ± {self.standard_errors[name]:.1g} {_UNITS[name]}"
            for name in _NAMES
        )
        seen = (
            f"{1e3 * self.mean_error(False):.2f} mm off, {1e3 * self.mean_error(False, True):.2f} mm without"
        )
        unseen = self.mean_error(True)
        others = (
            ""
            if np.isnan(unseen)
            else (
                f"; on unseen voltages {1e3 * unseen:.2f} mm, {1e3 * self.mean_error(True, True):.2f} mm without"
            )
        )
        return (
            f"In the first {WINDOW_S:g} s of {len(self.lifts)} lifts the load swings: the law with its inertia "
            f"({values}) is {seen}{others}."
        )

    def to_json(self) -> dict:
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


class _Swings:
    """Recordings whose swings are simulated together, with one table of forces each."""

    def __init__(self, recordings: Sequence[BenchRecording], muscle: Muscle) -> None:
        self.muscle = muscle
        self.recordings = [r for r in recordings if shows_swings(r)]
        self.stretches = [stretches_of(r) for r in self.recordings]
        self._tables: list[ForceTable] = []
        self.loads = [float(np.nanmedian(r.load)) for r in self.recordings]
        self.largest = [float(np.abs(r.voltage).max()) for r in self.recordings]

    @property
    def tables(self) -> list[ForceTable]:
        """The law of every recording's load, made when first asked for."""
        if not self._tables:
            pairs = zip(self.loads, self.largest, strict=True)
            self._tables = [force_table(self.muscle, load, volts) for load, volts in pairs]
        return self._tables

    def simulated(self, numbers: np.ndarray) -> list[np.ndarray]:
        """Contraction [m] of every recording."""
        found = []
        for recording, load, volts, table in zip(
            self.recordings, self.loads, self.largest, self.tables, strict=True
        ):
            hanging = HangingLoad(self.muscle, load, volts, *numbers.tolist())
            found.append(hanging.contraction(recording.time, recording.voltage, table))
        return found

    def lifts(self, numbers: np.ndarray, unseen: Sequence[float]) -> list[Lift]:
        """All lifts."""
        out = []
        pairs = zip(self.recordings, self.stretches, self.loads, self.simulated(numbers), strict=True)
        for recording, stretches, load, x in pairs:
            levels = np.array([each.level for each in stretches])
            settled = self.muscle.balanced(levels, np.full(len(levels), load), np.full(len(levels), load))
            for each, alone in zip(stretches, settled.tolist(), strict=True):
                time = recording.time[each.samples] - recording.time[each.samples[0]]
                measured = recording.contraction[each.samples] - each.zero
                known = bool(np.any(np.abs(np.array(unseen, dtype=float) - each.level) <= SAME * each.level))
                out.append(Lift(each.level, time, measured, x[each.samples], alone, known))
        return out


def swinging(
    recordings: Sequence[BenchRecording], muscle: Muscle, unseen: Sequence[float] = ()
) -> Swinging | None:
    """Fit damping, force-velocity slope and lag to the lifts of the other voltages; None where too few are seen swing.

    muscle: with its law fitted to settled frames, which stays; unseen: voltages [V] that are not fitted.
    """
    swings = _Swings(recordings, muscle)
    first = swings.lifts(np.zeros(3), unseen) if any(swings.stretches) else []
    if sum(not lift.unseen for lift in first) < _FEWEST_LIFTS:
        return None

    def residual(x: np.ndarray) -> np.ndarray:
        fitted = [lift for lift in swings.lifts(x * _START, unseen) if not lift.unseen]
        return np.concatenate([np.nan_to_num(lift.swinging - lift.measured) for lift in fitted])

    found = least_squares(
        residual, np.ones(3), bounds=(0.0, _UPPER / _START), diff_step=1e-2, x_scale=1.0, max_nfev=40
    )
    numbers = found.x * _START
    lifts = swings.lifts(numbers, unseen)
    fitted = [lift for lift in lifts if not lift.unseen]
    each = np.concatenate([np.full(len(lift.time), number) for number, lift in enumerate(fitted)])
    errors = scatter_between_runs(found.jac, found.fun, each) * _START
    pairs = list(zip(_NAMES, numbers.tolist(), errors.tolist(), strict=True))
    return Swinging(tuple(lifts), {n: v for n, v, _ in pairs}, {n: e for n, _, e in pairs})
