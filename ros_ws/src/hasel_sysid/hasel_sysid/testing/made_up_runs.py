"""A model beside runs, for tests: what it misses in every frame is known, and nothing is simulated."""

from collections.abc import Sequence

import numpy as np
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import Model
from hasel_sim.run import Run, Simulation

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.compare.run_comparison import RunComparison
from hasel_sysid.estimation.result import FitResult
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
    count, frames = residual.shape
    series = np.zeros(frames) if simulated is None else simulated
    slopes = np.zeros((frames, len(names))) if jacobian is None else jacobian
    nothing = np.zeros((frames, 0))
    simulations = tuple(
        Simulation(Run(f"run {n}", time, schedule), series, names, slopes, nothing, nothing)
        for n, schedule in enumerate(schedules or [None] * count)
    )
    return Evaluation(
        model,
        names,
        simulations,
        residual.ravel(),
        np.tile(slopes, (count, 1)),
        np.repeat(np.arange(count), frames),
        np.zeros(count),
        (np.ones(frames, dtype=bool),) * count,
    )


def made_up_fit(model: Model, error: float, at_bound: tuple[str, ...] = ()) -> FitResult:
    """A fit with this mean |Δ sin θ|, of the model's free parameters."""
    evaluation = made_up_evaluation(
        error * np.array([[1.0, -1.0]]), np.array([0.0, 0.01]), names=model.free, model=model
    )
    return FitResult(model, evaluation, at_bound, (), 1, "least_squares")


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
