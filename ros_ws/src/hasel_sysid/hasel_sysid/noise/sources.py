"""The noise of the measured angle where recordings show it alone: given, between repeated runs, or at rest."""

from collections.abc import Sequence

import numpy as np
from hasel_sim.run import Run
from scipy.stats import median_abs_deviation

from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment
from hasel_sysid.noise.model import FEWEST, NoiseModel, estimate_noise

_SEED_SHARE = 1 / 3
"""Share of the frames before the start from which the scatter at rest is first read."""
_STILL = 6.0
"""Robust standard deviations beyond which a frame has moved."""
_MUCH_LESS = 0.1
"""At rest a body scatters by less than this share of what it moves by; a stretch that does not is not at rest."""


def measured_noise(experiments: Sequence[Experiment]) -> NoiseModel | None:
    """The noise between repeated runs, else at rest; None where these recordings show neither."""
    repeats = differences_of_repeats(experiments)
    if repeats:
        return _of(repeats, f"differences between {len(repeats)} pair(s) of repeated runs")
    rests = rest_stretches(experiments)
    frames = sum(map(len, rests))
    return _of(rests, f"{frames} frames at rest") if rests else None


def given_noise(standard_deviation: float) -> NoiseModel:
    """White noise of a known standard deviation of sin theta. Raises SysidError unless it is positive."""
    if not (np.isfinite(standard_deviation) and standard_deviation > 0):
        raise SysidError(
            f"the noise is given as {standard_deviation:g}; expected a standard deviation of sin θ above 0, "
            "such as 0.003"
        )
    return NoiseModel(standard_deviation**2, 0.0, 0.5, "as given")


def _of(stretches: Sequence[np.ndarray], source: str) -> NoiseModel:
    runs = np.repeat(np.arange(len(stretches)), [len(s) for s in stretches])
    means = (runs[:, None] == np.arange(len(stretches))).astype(float)
    return estimate_noise(np.concatenate(stretches), runs, means, source)


def differences_of_repeats(experiments: Sequence[Experiment]) -> list[np.ndarray]:
    """Differences [frames] of runs with the same frames, drive and start, scaled to the noise of one of them.

    The mean of each is removed, as every series' offset is. Of three repeats the third is left out.
    """
    found, rest = [], list(experiments)
    while rest:
        one = rest.pop(0)
        twin = next((other for other in rest if _same(one.run, other.run)), None)
        if twin is None:
            continue
        rest.remove(twin)
        for difference in ((one.outputs - twin.outputs) / np.sqrt(2.0)).T:
            seen = difference[np.isfinite(difference)]
            if len(seen) >= FEWEST and np.ptp(seen) > 0:
                found.append(seen - seen.mean())
    return found


def _same(one: Run, other: Run) -> bool:
    start = (one.initial_state, one.initial_load_factor, one.initial_time)
    if start != (other.initial_state, other.initial_load_factor, other.initial_time):
        return False
    if len(one.time) != len(other.time) or not np.allclose(one.time, other.time, atol=1e-6):
        return False
    first, second = one.schedule, other.schedule
    if first is None or second is None:
        return first is second
    return (
        first.signal.shape == second.signal.shape
        and np.allclose(first.time, second.time, atol=1e-6)
        and np.allclose(first.signal, second.signal)
    )


def rest_stretches(experiments: Sequence[Experiment]) -> list[np.ndarray]:
    """Every measured output [frames] while the body rests at the beginning of each run, the stretch's mean removed.

    Series without at least 16 such frames are left out.
    """
    return [stretch for e in experiments for one in e.outputs.T if (stretch := _at_rest(e, one)) is not None]


def _at_rest(experiment: Experiment, series: np.ndarray) -> np.ndarray | None:
    measured = np.isfinite(series)
    if not measured.any():
        return None
    before = measured & (experiment.run.time < _start(experiment))
    early, motion = series[before], float(np.std(series[measured]))
    count = _still_frames(early)
    if count < FEWEST:
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
    if len(series) < FEWEST:
        return 0
    seed = series[: max(FEWEST // 2, int(_SEED_SHARE * len(series)))]
    centre = np.median(seed)
    spread = median_abs_deviation(seed, scale="normal")
    moved = np.flatnonzero(np.abs(series - centre) > _STILL * spread)
    return int(moved[0]) if len(moved) else len(series)
