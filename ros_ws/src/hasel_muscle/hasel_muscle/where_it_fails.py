"""Where a muscle's law fails, in sentences: how much by voltage, while a lift is held, after release, by polarity."""

from collections.abc import Iterator

import numpy as np
from hasel_sim.muscle.muscle import Muscle

from hasel_muscle.problem import BenchProblem
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
    means = [(v, run.measured[here].mean(), law[here].mean()) for v, here in _by_level(level, driven)]
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


def _by_level(level: np.ndarray, driven: np.ndarray) -> Iterator[tuple[float, np.ndarray]]:
    for each in np.unique(level[driven]):
        yield float(each), driven & (level == each)


def _more_or_less(is_: float, says: float) -> str:
    if abs(says) < 1e-12:
        return "though the law says nothing"
    share = is_ / says - 1
    return f"{abs(100 * share):.0f} % {'more' if share > 0 else 'less'}"


def _drift(time: np.ndarray, away: np.ndarray, hold: np.ndarray, driven: np.ndarray) -> float | None:
    """Mean slope within driven holds [per s]."""
    slopes = []
    for number in np.unique(hold[driven]):
        here = hold == number
        if here.sum() > 2:
            slopes.append(np.polyfit(time[here] - time[here].mean(), away[here], 1)[0])
    return float(np.mean(slopes)) if slopes else None


def _shown(value: float, unit: str) -> str:
    return f"{1e3 * value:.2g} mm" if unit == "m" else f"{value:.2g} N"
