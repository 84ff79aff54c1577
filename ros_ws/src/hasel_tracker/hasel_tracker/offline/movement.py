"""When the body begins to move, and the seed paper's cut: two periods from there."""

import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.tracked_run import TrackedRun

REST_FRAMES = 6
CLEAR_OF_NOISE = 6.0
LEAST_MOVEMENT = 0.002
MEDIAN_OF_SECOND_DIFFERENCES = 1.65  # of white noise with standard deviation one: 0.6745 · √6


def first_movement_s(time_s: np.ndarray, sin_theta: np.ndarray) -> float:
    """Time [s] of the last frame at rest before sin θ leaves its resting value for good.

    The resting value and its noise come from the first frames. Raises TrackerError if nothing ever moves,
    or if the body moves from the start.
    """
    seen = np.isfinite(sin_theta)
    time_s, sin_theta = time_s[seen], sin_theta[seen]
    if len(sin_theta) < 2 * REST_FRAMES:
        raise TrackerError(
            f"There are {len(sin_theta)} frames with an angle; expected at least {2 * REST_FRAMES} to "
            f"find the start."
        )
    rest = np.median(sin_theta[:REST_FRAMES])
    # Second differences: a body that moves steadily from the start is not taken for noise.
    noise = np.median(np.abs(np.diff(sin_theta[:REST_FRAMES], 2))) / MEDIAN_OF_SECOND_DIFFERENCES
    away = np.abs(sin_theta - rest) > max(CLEAR_OF_NOISE * noise, LEAST_MOVEMENT)
    lasting = away[:-1] & away[1:]
    if not lasting.any():
        raise TrackerError(
            f"sin θ never moves more than {np.abs(sin_theta - rest).max():.4f} from its start; "
            "check that the run was driven, or leave the cut out."
        )
    moved = int(np.argmax(lasting))
    if moved < REST_FRAMES - 1:
        raise TrackerError(
            f"The body moves within the first {REST_FRAMES} frames, so its start cannot be seen; "
            "begin recording before the drive, or leave the cut out."
        )
    return float(time_s[moved - 1])


def cut_to_periods(run: TrackedRun, frequency_hz: float, periods: float = 2.0) -> TrackedRun:
    """The run from the first movement on, for so many periods of the drive; its time starts at zero there."""
    if not (frequency_hz > 0.0 and periods > 0.0):
        raise TrackerError(
            f"Cannot cut to {periods} periods of {frequency_hz} Hz; expected positive numbers."
        )
    start = first_movement_s(run.time_s, run.sin_theta)
    end = start + periods / frequency_hz
    if end > run.time_s[-1] + 1.5 / run.frame_rate_hz:
        raise TrackerError(
            f"From the first movement at {start:.3f} s the run has {run.time_s[-1] - start:.3f} s, less than "
            f"{periods:g} periods of {frequency_hz:g} Hz ({periods / frequency_hz:.3f} s); cut to fewer "
            f"periods."
        )
    return run.between(start, end)
