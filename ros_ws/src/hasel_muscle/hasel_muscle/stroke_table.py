"""What a table of measured strokes with interpolation between its voltages would say: the law's rival."""

from dataclasses import dataclass

import numpy as np
from hasel_sim.drive.amplitudes import target_contraction
from hasel_sim.muscle.muscle import Muscle

from hasel_muscle.problem import BenchProblem

_ONE_LOAD = 0.02


@dataclass(frozen=True)
class Rival:
    """Mean |error| [m] on unseen lifts, of law and table; releases are left out, of which no table knows."""

    law: float
    table: float

    def __str__(self) -> str:
        return (
            f"On unseen lifts alone the law is {1e3 * self.law:.3g} mm off, a table of the fitted strokes, "
            f"interpolated, {1e3 * self.table:.3g} mm."
        )


def rival_table(fitted: BenchProblem, unseen: BenchProblem, muscle: Muscle) -> Rival | None:
    """Law and table on the same unseen lifts; None where loads differ or lengths are held.

    The table is that of the swimmer's amplitudes: monotone between its voltages, on with the last slope beyond.
    """
    runs = [*fitted.runs, *unseen.runs]
    loads = np.concatenate([run.load[run.used] for run in runs])
    if any(run.held != "load" for run in runs) or np.ptp(loads) > _ONE_LOAD * np.abs(loads).max():
        return None
    levels = fitted.voltages
    means = [np.mean(fitted.measured[fitted.driven & (fitted.levels == level)]) for level in levels]
    lifts = unseen.driven
    said = target_contraction(unseen.levels[lifts], levels, np.maximum.accumulate(means))

    def off(answer: np.ndarray) -> float:
        return float(np.average(np.abs(answer - unseen.measured[lifts]), weights=unseen.weights[lifts]))

    return Rival(off(unseen.predicted(muscle)[lifts]), off(said))
