"""Noise from what differs between one period of the drive and the next."""

import numpy as np

from hasel_sysid.noise import NoiseModel, estimate_noise
from hasel_sysid.problem import Evaluation
from hasel_sysid.projection import orthonormal
from hasel_sysid.where_it_fails.drive_cycle import drive_cycle

_FEWEST_FRAMES = 16


def noise_between_periods(evaluation: Evaluation) -> NoiseModel | None:
    """The noise, from the residual's differences between frames one period apart; None where no drive repeats.

    What a model misses in every period alike drops out. What it misses while the motion builds up does not, so this
    errs to the loud side only.
    """
    residual, columns, runs = [], [], []
    for number, (simulation, used) in enumerate(zip(evaluation.simulations, evaluation.frames, strict=True)):
        lag = _frames_per_period(simulation.run.time[used], simulation.run.schedule)
        here = evaluation.runs == number
        if lag is None or here.sum() < lag + _FEWEST_FRAMES:
            continue
        residual.append(_differences(evaluation.residual[here], lag))
        columns.append(_differences(evaluation.jacobian[here], lag))
        runs.append(np.full(len(residual[-1]), number))
    if not residual:
        return None
    return estimate_noise(
        np.concatenate(residual),
        np.concatenate(runs),
        orthonormal(np.concatenate(columns)),
        "what differs between periods of the drive",
    )


def _frames_per_period(time: np.ndarray, schedule) -> int | None:
    cycle = drive_cycle(time, schedule.at(time)) if schedule is not None and len(time) > 1 else None
    return None if cycle is None else max(1, round(cycle.period / float(np.median(np.diff(time)))))


def _differences(series: np.ndarray, lag: int) -> np.ndarray:
    """Scaled so that independent noise keeps its variance."""
    return (series[lag:] - series[:-lag]) / np.sqrt(2.0)
