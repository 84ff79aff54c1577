"""Noise from runs that were made twice: what differs between them is nothing that a model could predict."""

from collections.abc import Sequence

import numpy as np
from hasel_sim.run import Run

from hasel_sysid.dataset import Experiment

_FEWEST_FRAMES = 16


def differences_of_repeats(experiments: Sequence[Experiment]) -> list[np.ndarray]:
    """Differences [frames] of runs with the same frames, drive and start, scaled to the noise of one of them.

    The mean of each is removed, as every run's offset is. Of three repeats the third is left out.
    """
    found, rest = [], list(experiments)
    while rest:
        one = rest.pop(0)
        twin = next((other for other in rest if _same(one.run, other.run)), None)
        if twin is None:
            continue
        rest.remove(twin)
        difference = (one.sin_theta - twin.sin_theta) / np.sqrt(2.0)
        difference = difference[np.isfinite(difference)]
        if len(difference) >= _FEWEST_FRAMES and np.ptp(difference) > 0:
            found.append(difference - difference.mean())
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
