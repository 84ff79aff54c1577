# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults of the set-up as hypotheses: how the runs would have to be read, each a rival of all that is physics.

A dead channel, exchanged channels, an inverted angle, clocks that differ. What cannot be physics, such as frames out of
order, is refused by the data gate.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.errors import SysidError
from hasel_sysid.estimation.least_squares import bounded_change, values_and_bounds
from hasel_sysid.experiment import Experiment
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Evaluation, Problem

Reading = Callable[[Experiment], Experiment]
DECIDED = ("sign flip or swapped channels", "dead channel", "command lag", "motion before command")
"""Findings of the data gate that physics can look like: beside a model they are decided here."""
_LONGEST_SHIFT_S, _LONGEST_STEP_S = 0.3, 0.1
_MOST_STEPS, _SHIFT_TOLERANCE = 6, 0.1
_FEWEST_FRAMES = 3


@dataclass(frozen=True)
class SetUpFault:
    """what: the fault, as in "the channels are exchanged"; runs: names of those that have it; everywhere: whether all
    have; reading: a run as it is to be read; advice: what to do.
    """

    what: str
    runs: tuple[str, ...]
    everywhere: bool
    reading: Reading
    advice: str

    @property
    def size(self) -> int:
        """How many statements it makes: one, or one of every run."""
        return 1 if self.everywhere else len(self.runs)

    def read(self, experiments: Sequence[Experiment]) -> list[Experiment]:
        """The runs as they are to be read."""
        return [
            self.reading(each) if self.everywhere or each.name in self.runs else each for each in experiments
        ]

    def __str__(self) -> str:
        where = "all runs" if self.everywhere else ", ".join(self.runs)
        return (
            f"A fault of the set-up: {self.what} in {where}, which is read accordingly here; {self.advice}."
        )


def hypotheses(problem: Problem, models: Sequence[Model]) -> list[SetUpFault]:
    """The faults that would take most of the error of a run away, its own best parameters followed to first order.

    models: about which that is asked, such as before and after a fit: a fit to a fault may no longer move at all.
    """
    recorded = [seen for seen in (_evaluated(problem, model) for model in models) if seen is not None]
    if not recorded:
        return []
    squares = np.min([_squares_of_runs(seen) for seen in recorded], axis=0)
    found = []
    for what, advice, reading in _kinds(problem.experiments):
        read = _as_read(problem, reading)
        changed = [new is not old for new, old in zip(read.experiments, problem.experiments, strict=True)]
        if not any(changed):
            continue
        seen = [one for one in (_evaluated(read, model) for model in models) if one is not None]
        if not seen:
            continue
        better = changed & _removes_most(squares, np.min([_squares_of_runs(one) for one in seen], axis=0))
        runs = tuple(e.name for e, here in zip(problem.experiments, better, strict=True) if here)
        if _most(runs, read.experiments):
            # what most have, all have: the fit to the runs as they are then read will tell
            runs = tuple(e.name for e in read.experiments)
        if runs:
            found.append(SetUpFault(what, runs, len(runs) == len(read.experiments), reading, advice))
    return [*found, *_clocks(problem, models[-1], recorded, squares)]


def _kinds(experiments: Sequence[Experiment]) -> list[tuple[str, str, Reading]]:
    """What may be wrong of every run alike, advice, and how a run is then to be read."""
    schedules = [e.run.schedule for e in experiments if e.run.schedule is not None]
    channels = list(dict.fromkeys(name for schedule in schedules for name in schedule.channels))
    kinds = [("the measured angle has the wrong sign", "see which marker is the head", _inverted)]
    if len(channels) == 2:
        kinds.append(("the two channels are exchanged", "compare the cables of the two muscles", _exchanged))
    return kinds + [
        (f"the {name} channel is dead", f"check cable, fuse and muscle of the {name} channel", _without(name))
        for name in channels
    ]


def _as_read(problem: Problem, reading: Reading) -> Problem:
    return problem.with_experiments([reading(each) for each in problem.experiments])


def _rate(seen: Evaluation) -> np.ndarray:
    """Rates [1/s] of the simulated outputs at the frames of the residual, without the mean of every series."""
    rates = [
        np.gradient(np.nan_to_num(s.outputs[:, output]), s.time)[used]
        for s, output, used, _ in seen.each_series()
    ]
    return np.concatenate([rate - rate.mean() for rate in rates])


def _clocks(
    problem: Problem, model: Model, recorded: Sequence[Evaluation], squares: np.ndarray
) -> list[SetUpFault]:
    """The few runs whose angle is shifted in time. What most share is left to the effects that are a lag, the clocks of
    camera and drive among them.
    """
    shifts: dict[str, float] = {}
    for number, experiment in enumerate(problem.experiments):
        if len(experiment.run.time) < _FEWEST_FRAMES or experiment.run.schedule is None:
            continue
        lag, left = min((_best_shift(seen, number) for seen in recorded), key=lambda one: one[1])
        if abs(lag) > _frame(problem) and _removes_most(squares[number], left):
            shifts[experiment.name] = lag
    if not shifts or _most(shifts, problem.experiments):
        return []
    shifts = _settled(problem, model, shifts)
    told = ", ".join(f"{1e3 * lag:+.0f} ms" for lag in shifts.values())
    what = f"the clock of the angle is off by {told}"
    return [
        SetUpFault(what, tuple(shifts), False, _shifted(shifts), "compare the clocks of supply and camera")
    ]


def _settled(problem: Problem, model: Model, lags: Mapping[str, float]) -> dict[str, float]:
    """Lags [s] of runs, by name, found with the model's parameters (Gauss-Newton, a few steps)."""
    lags, change = dict(lags), np.array([np.inf])
    whose = np.array([[e.name == name for e in problem.experiments] for name in lags])
    for _ in range(_MOST_STEPS):
        seen = _evaluated(_as_read(problem, _shifted(lags)), model)
        if seen is None:
            break
        if np.abs(change).max() < _SHIFT_TOLERANCE * _frame(problem):
            break
        columns = -_rate(seen)[:, None] * whose[:, seen.runs].T
        value, lower, upper = values_and_bounds(seen.model, seen.names)
        reach = np.full(len(whose), _LONGEST_STEP_S)
        down, up = np.append(lower - value, -reach), np.append(upper - value, reach)
        step, _ = bounded_change(seen.residual, np.column_stack([seen.jacobian, columns]), down, up)
        change = step[len(value) :]
        model = model.with_values(dict(zip(seen.names, value + step[: len(value)], strict=True)))
        lags = {name: lag + float(by) for (name, lag), by in zip(lags.items(), change, strict=True)}
    return lags


def _frame(problem: Problem) -> float:
    """Longest distance of two frames [s], the median of a run."""
    frames = [float(np.median(np.diff(e.run.time))) for e in problem.experiments if len(e.run.time) > 1]
    return max(frames, default=np.inf)


def _most(runs: Collection[str], experiments: Sequence[Experiment]) -> bool:
    return 2 * len(runs) > len(experiments)


def _evaluated(problem: Problem, model: Model) -> Evaluation | None:
    try:
        return problem.evaluate(problem.low_fidelity(model), model.free)
    except SimulationError:
        return None


def _removes_most(before: npt.ArrayLike, after: npt.ArrayLike) -> np.ndarray:
    """Of sums of squares: whether they fall by as much as an explanation must take away."""
    return np.asarray(after) < (1 - POLICY.part) * np.asarray(before)


def _squares_of_runs(seen: Evaluation) -> np.ndarray:
    """What every run would leave with parameters of its own, to first order, [runs]."""
    parts = [seen.runs == number for number in range(len(seen.simulations))]
    return np.array([_followed(seen, seen.residual[p], seen.jacobian[p]) for p in parts])


def _followed(seen: Evaluation, residual: np.ndarray, jacobian: np.ndarray) -> float:
    """Sum of squares that parameters within their bounds would leave, to first order."""
    value, lower, upper = values_and_bounds(seen.model, seen.names)
    return bounded_change(residual, jacobian, lower - value, upper - value)[1]


def _best_shift(seen: Evaluation, number: int) -> tuple[float, float]:
    """The lag [s] of one run's angle at which a motion of any size leaves least, and the sum of squares that is left
    there, the run's own parameters followed.
    """
    here = seen.runs == number
    whole = seen.simulations[number].time
    parts = [(whole[used], own[here]) for s, _, used, own in seen.each_series() if own[here].any()]
    simulated, measured = seen.simulated()[here], seen.measured()[here]
    lags = np.arange(-_LONGEST_SHIFT_S, _LONGEST_SHIFT_S, float(np.median(np.diff(whole))))
    moved = np.array([_moved(parts, simulated, lag) for lag in lags])
    power = np.maximum((moved**2).sum(axis=1), 1e-300)
    lag = float(lags[int(np.argmax(np.maximum(moved @ measured, 0.0) ** 2 / power))])
    columns = [_moved(parts, column, lag) for column in seen.jacobian[here].T]
    residual = measured - _moved(parts, simulated, lag)
    return lag, _followed(seen, residual, np.reshape(columns, (-1, len(residual))).T)


def _moved(parts: Sequence[tuple[np.ndarray, np.ndarray]], values: np.ndarray, lag: float) -> np.ndarray:
    """Values [frames] of a run so much later; parts: time [s] of every output, and where it is [frames]."""
    out = np.empty_like(values)
    for time, here in parts:
        later = np.interp(time - lag, time, values[here])
        out[here] = later - later.mean()
    return out


def _inverted(experiment: Experiment) -> Experiment:
    recording = experiment.recording
    return replace(experiment, recording=replace(recording, sin_theta=-recording.sin_theta))


def _driven_by(experiment: Experiment, time: np.ndarray, signal: np.ndarray) -> Experiment:
    if experiment.run.schedule is None:
        raise SysidError(f"{experiment.name} is passive; expected a run that is driven")
    schedule = replace(experiment.run.schedule, time=time, signal=signal)
    return replace(experiment, run=replace(experiment.run, schedule=schedule))


def _exchanged(experiment: Experiment) -> Experiment:
    schedule = experiment.run.schedule
    if schedule is None or len(schedule.channels) != 2:
        return experiment
    return _driven_by(experiment, schedule.time, schedule.signal[:, ::-1])


def _without(channel: str) -> Reading:
    """A run that is driven on another channel too, without which nothing would move."""

    def reading(experiment: Experiment) -> Experiment:
        schedule = experiment.run.schedule
        if schedule is None:
            return experiment
        dead = np.array([name == channel for name in schedule.channels])
        driven = np.any(schedule.signal != 0, axis=0)
        if not (driven & dead).any() or not (driven & ~dead).any():
            return experiment
        return _driven_by(experiment, schedule.time, schedule.signal * ~dead)

    return reading


def _shifted(lags: Mapping[str, float]) -> Reading:
    """lags [s]: of the angle behind the drive, by name of the run; none of any other."""

    def reading(experiment: Experiment) -> Experiment:
        schedule = experiment.run.schedule
        if schedule is None:
            return experiment
        lag = lags.get(experiment.name, 0.0)
        return _driven_by(experiment, schedule.time + lag, schedule.signal)

    return reading
