"""A model beside runs, for tests: what it misses in every frame is known, and nothing is simulated."""

from collections.abc import Sequence

import numpy as np
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import Model
from hasel_sim.run import Run, Simulation

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.compare.run_comparison import RunComparison
from hasel_sysid.estimation import FittedModel
from hasel_sysid.problem import Evaluation
from hasel_sysid.where_it_fails.analyse import where_it_fails
from hasel_sysid.where_it_fails.run_series import run_series


def made_up_evaluation(
    residual: np.ndarray,
    time: np.ndarray,
    schedules: Sequence[DriveSchedule | None] | None = None,
    simulated: np.ndarray | None = None,
    jacobian: np.ndarray | None = None,
    names: tuple[str, ...] = (),
    model: Model | None = None,
) -> Evaluation:
    """Runs with the same frames.

    residual [runs, frames]; time [s] [frames]; schedules: of every run (default: passive); simulated: sin theta
    [frames], the same in every run (default: 0); jacobian [frames, parameters], likewise.
    """
    count = len(residual)
    runs = [Run(f"run {n}", time, schedule) for n, schedule in enumerate(schedules or [None] * count)]
    return evaluation_of_runs(
        runs,
        residual.ravel(),
        None if simulated is None else np.tile(simulated, count),
        None if jacobian is None else np.tile(jacobian, (count, 1)),
        names,
        model,
    )


def evaluation_of_runs(
    runs: Sequence[Run],
    residual: np.ndarray,
    simulated: np.ndarray | None = None,
    jacobian: np.ndarray | None = None,
    names: tuple[str, ...] = (),
    model: Model | None = None,
) -> Evaluation:
    """Runs with frames of their own, one after the other.

    residual, simulated (default: 0) [frames of all runs]; jacobian [frames of all runs, parameters].
    """
    lengths = [len(run.time) for run in runs]
    series = np.zeros(len(residual)) if simulated is None else simulated
    slopes = np.zeros((len(residual), len(names))) if jacobian is None else jacobian
    of_runs = np.repeat(np.arange(len(runs)), lengths)
    simulations = tuple(
        Simulation(
            run,
            series[of_runs == n],
            names,
            slopes[of_runs == n],
            np.zeros((length, 0)),
            np.zeros((length, 0)),
        )
        for n, (run, length) in enumerate(zip(runs, lengths, strict=True))
    )
    frames = tuple(np.ones((length, 1), dtype=bool) for length in lengths)
    return Evaluation(model, names, simulations, residual, slopes, of_runs, np.zeros(len(runs)), frames)


def made_up_fit(model: Model, error: float, at_bound: tuple[str, ...] = ()) -> FittedModel:
    """A fit with this mean |Δ sin θ|, of the model's free parameters."""
    evaluation = made_up_evaluation(
        error * np.array([[1.0, -1.0]]), np.array([0.0, 0.01]), names=model.free, model=model
    )
    return FittedModel(model, evaluation, at_bound, (), 1, "least_squares")


def made_up_comparison(model: Model, label: str, error: float, unseen: float) -> Comparison:
    """A comparison with these means of |Δ sin θ|: one fitted run of two frames, and one unseen."""
    time = np.array([0.0, 0.01])
    series = [
        run_series(name, time, size * np.array([1.0, -1.0]), np.zeros(2))
        for name, size in (("fitted", error), ("unseen", unseen))
    ]
    where = where_it_fails(series)
    runs = tuple(
        RunComparison(one, one.name == "unseen", found) for one, found in zip(series, where.runs, strict=True)
    )
    return Comparison(label, model, runs, where)
