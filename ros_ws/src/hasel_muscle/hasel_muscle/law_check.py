# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where a muscle's law fails, in sentences, and whether a table of measured strokes would say more than it."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from hasel_sim.drive.amplitudes import target_contraction
from hasel_sim.muscle.muscle import Muscle

from hasel_muscle.bench_problem import BenchProblem
from hasel_muscle.settled import SettledRun

_WORTH_SAYING = 0.01
"""Of the largest answer."""


def where_it_fails(problem: BenchProblem, muscle: Muscle) -> tuple[str, ...]:
    """One sentence per kind of failure that is worth saying, of every run."""
    return tuple(said for run in problem.runs for said in _sentences(run, muscle, problem.scales[run.unit]))


def _sentences(run: SettledRun, muscle: Muscle, scale: float) -> Iterator[str]:
    away = run.measured - run.predicted(muscle)
    law = run.measured - away
    level, voltage, hold = (each[run.used] for each in (run.level, run.voltage, run.hold))
    driven = voltage != 0
    verb = "contracts" if run.held == "load" else "pulls"
    by_level = [(float(volts), driven & (level == volts)) for volts in np.unique(level[driven])]
    means = [(volts, run.measured[here].mean(), law[here].mean()) for volts, here in by_level]
    strong = [(v, is_, says) for v, is_, says in means if max(abs(is_), abs(says)) > _WORTH_SAYING * scale]
    if strong and max(abs(is_ - says) for _, is_, says in strong) > _WORTH_SAYING * scale:
        shares = [f"{_more_or_less(is_, says)} at {v:g} V" for v, is_, says in (strong[0], strong[-1])]
        yield f"{run.name}: {verb} {', '.join(dict.fromkeys(shares))} than the law."
    drift = _drift(run.time[run.used], away, hold, driven)
    if drift is not None and abs(drift) > 0.1 * _WORTH_SAYING * scale:
        yield f"{run.name}: goes on by {_shown(drift, run.unit)} per second while a lift is held, beside the law."
    after = away[~driven & (level > 0)]
    if len(after) and np.abs(after).max() > _WORTH_SAYING * scale:
        worst = after[np.argmax(np.abs(after))]
        yield f"{run.name}: up to {_shown(worst, run.unit)} are left after release, beside the law."
    up, down = away[driven & (voltage > 0)], away[driven & (voltage < 0)]
    if len(up) and len(down) and abs(up.mean() - down.mean()) > _WORTH_SAYING * scale:
        more = _shown(up.mean() - down.mean(), run.unit)
        yield f"{run.name}: does {more} more at positive voltages than at negative ones."


def _more_or_less(is_: float, says: float) -> str:
    if abs(says) < 1e-12:
        return "though the law says nothing"
    share = is_ / says - 1
    return f"{abs(100 * share):.0f} % {'more' if share > 0 else 'less'}"


def _drift(time: np.ndarray, away: np.ndarray, hold: np.ndarray, driven: np.ndarray) -> float | None:
    """Mean slope within driven holds [per s]."""
    within = [hold == number for number in np.unique(hold[driven])]
    slopes = [np.polyfit(time[h] - time[h].mean(), away[h], 1)[0] for h in within if h.sum() > 2]
    return float(np.mean(slopes)) if slopes else None


def _shown(value: float, unit: str) -> str:
    return f"{1e3 * value:.2g} mm" if unit == "m" else f"{value:.2g} N"


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
