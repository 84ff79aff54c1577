"""Noise from frames in which the body is at rest: before it is let go, before the drive begins."""

from collections.abc import Sequence

import numpy as np

from hasel_sysid.dataset import Experiment

_FEWEST_FRAMES = 16
_SEED_SHARE = 1 / 3
"""Share of the frames before the start from which the scatter at rest is first read."""
_STILL = 6.0
"""Robust standard deviations beyond which a frame has moved."""
_MUCH_LESS = 0.1
"""At rest a body scatters by less than this share of what it moves by; a stretch that does not is not at rest."""
_TO_SIGMA = 1.4826


def rest_stretches(experiments: Sequence[Experiment]) -> list[np.ndarray]:
    """The measured angle [frames] while the body rests at the beginning of each run, the stretch's mean removed.

    Runs without at least 16 such frames are left out.
    """
    return [stretch for e in experiments if (stretch := _at_rest(e)) is not None]


def _at_rest(experiment: Experiment) -> np.ndarray | None:
    measured = np.isfinite(experiment.sin_theta)
    before = measured & (experiment.run.time < _start(experiment))
    early, motion = experiment.sin_theta[before], float(np.std(experiment.sin_theta[measured]))
    count = _still_frames(early)
    if count < _FEWEST_FRAMES:
        return None
    stretch = early[:count] - early[:count].mean()
    scatter = float(np.std(stretch))
    return stretch if 0 < scatter < _MUCH_LESS * motion else None


def _start(experiment: Experiment) -> float:
    """When the body may begin to move [s]: at the first voltage, or when it is let go."""
    run = experiment.run
    if run.schedule is None:
        return run.start
    on = np.flatnonzero(np.any(run.schedule.signal != 0, axis=1))
    return float(run.schedule.time[on[0]]) if len(on) else float("inf")


def _still_frames(series: np.ndarray) -> int:
    """How many frames from the first on stay where the body rested."""
    if len(series) < _FEWEST_FRAMES:
        return 0
    seed = series[: max(_FEWEST_FRAMES // 2, int(_SEED_SHARE * len(series)))]
    centre = np.median(seed)
    spread = _TO_SIGMA * np.median(np.abs(seed - centre))
    moved = np.flatnonzero(np.abs(series - centre) > _STILL * spread)
    return int(moved[0]) if len(moved) else len(series)
