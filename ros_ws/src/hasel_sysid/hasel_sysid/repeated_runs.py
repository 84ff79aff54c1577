"""The same run given more than once: the same frames with the same angles, whatever its file is called."""

import warnings
from collections.abc import Iterable, Sequence

import numpy as np
from hasel_recording import Recording, RecordingWarning

from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment

_SAME_TIME_S = 1e-6
"""A copy in another format keeps times to the nanosecond, and may count from another zero."""


def counted_once(experiments: Iterable[Experiment]) -> list[Experiment]:
    """The experiments without repeats, each of which is left out with a RecordingWarning."""
    found: list[Experiment] = []
    for each in experiments:
        if not is_repeat(each.recording, [earlier.recording for earlier in found]):
            found.append(each)
    return found


def is_repeat(recording: Recording, earlier: Iterable[Recording]) -> bool:
    """Whether it is one of the earlier ones; a RecordingWarning says so where it is."""
    known = _same_run(recording, earlier)
    if known is not None:
        warnings.warn(
            f"{recording.name} is the same run as {known.name} (same times, same angles) and counts once: twice the "
            "same noise is not two runs.",
            RecordingWarning,
            stacklevel=3,
        )
    return known is not None


def check_unseen(unseen: Iterable[Experiment], fitted: Sequence[Experiment]) -> None:
    """Raise SysidError where an unseen run is also among those to fit."""
    for each in unseen:
        known = _same_run(each.recording, [other.recording for other in fitted])
        if known is not None:
            raise SysidError(
                f"{each.name}, given as unseen, is the same run as {known.name}, which is not (same times, same "
                "angles); an unseen run is never fitted: leave out one of the two"
            )


def _same_run(recording: Recording, others: Iterable[Recording]) -> Recording | None:
    """The one of the others that is the same run; None where there is none."""
    return next((other for other in others if _is_same(recording, other)), None)


def _is_same(a: Recording, b: Recording) -> bool:
    return np.array_equal(a.sin_theta, b.sin_theta, equal_nan=True) and np.allclose(
        a.time_s - a.time_s[:1], b.time_s - b.time_s[:1], rtol=0.0, atol=_SAME_TIME_S
    )
