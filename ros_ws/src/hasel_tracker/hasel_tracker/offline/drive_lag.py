# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How much later than the drive's clock the video's ran, from the whole run.

First the angle is predicted frame by frame from its own last values (whatever the body's dynamics, its rocking and its
drift are) and from the drive at a trial lag: near the right lag the drive foretells what the angle's own past cannot.
Then, where the drive steps and a rest is in view, the start tells when the body began to answer. The interval holds
what different ways of answering allow. A lag that the run does not determine (a steady beat is foretold as well a
period later) is refused.
"""

from dataclasses import dataclass

import numpy as np
from hasel_recording.recording import row_in_force

from hasel_tracker.errors import TrackerError

ORDER = 5
STEPS_PER_FRAME = 2
LEAST_FRAMES = 40
LEAST_GAIN = 25.0
RIVAL_LOSS = 6.0
RIVAL_APART_FRAMES = 4
INTERVAL_LOSS = 4.0
MODEL_FRAMES = 1.0
MODEL_LOSS = 20.0
LATEST_ANSWER_S = 0.08
LEAST_CHANGE = 0.05
MOST_LEVELS = 6
REST_S, REST_FRAMES, REST_SHARE = 0.2, 5, 0.25
FIRST_SWING_S, FIRST_SHARE = 0.1, 0.4


@dataclass(frozen=True)
class LagEstimate:
    """The lag [s], its interval's half width [s], and by how much the drive improves the log likelihood."""

    lag_s: float
    uncertainty_s: float
    gain: float


def estimate_lag(
    time_s: np.ndarray, sin_theta: np.ndarray, drive_time_s: np.ndarray, drive: np.ndarray, drive_end_s: float
) -> LagEstimate:
    """Lag [s] to add to the drive's times (k,), signals (k, channels) to get the video's (n,).

    A signal holds until the next, the last one until `drive_end_s`; before the first it is zero. Raises TrackerError
    if the lag is not determined.
    """
    frame_s = float(np.median(np.diff(time_s)))
    now, past, row_time_s = _predictable(time_s, sin_theta, frame_s)
    if len(now) < LEAST_FRAMES:
        raise TrackerError(
            f"There are {len(now)} frames in a row with an angle, expected {LEAST_FRAMES} to find the lag; give --lag."
        )
    if not np.abs(drive).max() > 0.0:
        raise TrackerError("The drive's recording is 0 V throughout; give that of the run in the video.")
    push = (np.abs(drive[:, 0]) - np.abs(drive[:, 1])) / float(np.abs(drive).max())
    if np.ptp(push) < LEAST_CHANGE:
        raise TrackerError(
            "The drive's recording never changes, so it has no lag to find; give --lag SECONDS."
        )
    lags = np.arange(row_time_s[0] - drive_end_s, row_time_s[-1] - drive_time_s[0], frame_s / STEPS_PER_FRAME)
    loss = _losses(now, past, row_time_s, lags, drive_time_s, push, drive_end_s, frame_s)
    change = drive_time_s[int(np.argmax(np.abs(push - push[0]) > LEAST_CHANGE * np.ptp(push)))]
    begins_s = change + lags[int(np.argmin(loss))] - LATEST_ANSWER_S
    if not _rests_before(begins_s, time_s, sin_theta):
        raise TrackerError(
            "The lag between video and drive is not determined: the body is not seen at rest before the drive starts, "
            "and a beat fits a period later as well; film the rest too, or give --lag SECONDS."
        )
    coarse = _judged(lags, loss, frame_s)
    return _from_the_start(time_s, sin_theta, drive_time_s, push, coarse, frame_s) or coarse


def _predictable(
    time_s: np.ndarray, sin_theta: np.ndarray, frame_s: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angles that follow ORDER frames without a gap (n,), what came before each (n, ORDER + 1), and their times."""
    windows = np.lib.stride_tricks.sliding_window_view(sin_theta, ORDER + 1)
    spans = time_s[ORDER:] - time_s[:-ORDER]
    whole = np.isfinite(windows).all(axis=1) & (spans < (ORDER + 0.5) * frame_s)
    past = np.column_stack([windows[whole, :-1], np.ones(whole.sum())])
    return windows[whole, -1], past, time_s[ORDER:][whole]


def _losses(
    now: np.ndarray,
    past: np.ndarray,
    row_time_s: np.ndarray,
    lags: np.ndarray,
    drive_time_s: np.ndarray,
    push: np.ndarray,
    end_s: float,
    frame_s: float,
) -> np.ndarray:
    """Twice the negative log likelihood of each lag, relative to prediction from the past alone."""
    basis, _ = np.linalg.qr(past)
    alone = now - basis @ (basis.T @ now)
    total = float(alone @ alone)
    edges = np.append(drive_time_s, end_s)
    charge = np.append(0.0, np.cumsum(push * np.diff(edges)))
    losses = np.empty(len(lags))
    for index, lag in enumerate(lags):
        at = row_time_s - lag
        # The mean of the drive over the frame before: what could act on this angle.
        mean = (np.interp(at, edges, charge) - np.interp(at - frame_s, edges, charge)) / frame_s
        mean[at > end_s] = 0.0
        fresh = mean - basis @ (basis.T @ mean)
        # The upper muscle bends the body to the positive side: the other sign would be half a beat off.
        merit = max(float(fresh @ alone), 0.0) ** 2 / max(float(fresh @ fresh), 1e-12)
        losses[index] = len(now) * np.log(max(total - merit, 1e-300) / total) + 2.0
    return losses


def _rests_before(begins_s: float, time_s: np.ndarray, sin_theta: np.ndarray) -> bool:
    """Whether the body is seen at rest before the drive begins."""
    seen = np.isfinite(sin_theta)
    before = sin_theta[seen & (time_s < begins_s)]
    return bool(len(before) >= REST_FRAMES and np.ptp(before) < REST_SHARE * np.ptp(sin_theta[seen]))


def _judged(lags: np.ndarray, loss: np.ndarray, frame_s: float) -> LagEstimate:
    """The best lag, unless another is about as good."""
    best = int(np.argmin(loss))
    gain = -float(loss[best])
    if gain < LEAST_GAIN:
        raise TrackerError(
            "The drive foretells nothing of the angle, so the lag is not determined; check that drive and video are of "
            "the same run, or give --lag SECONDS."
        )
    apart = np.abs(lags - lags[best]) > max(LATEST_ANSWER_S, RIVAL_APART_FRAMES * frame_s)
    rival = int(np.argmin(np.where(apart, loss, np.inf)))
    if apart.any() and loss[rival] < loss[best] + max(RIVAL_LOSS, 0.1 * gain):
        raise TrackerError(
            f"The lag between video and drive is not determined: {lags[best]:+.3f} s and {lags[rival]:+.3f} s fit "
            "about equally well; film the rest before the drive starts, or give --lag SECONDS."
        )
    # The drive foretells most when the body answers most, which is after it began to: by how much is not known here.
    low, high = lags[best] - LATEST_ANSWER_S, lags[best] + MODEL_FRAMES * frame_s
    return LagEstimate(float(0.5 * (low + high)), float(0.5 * (high - low)), gain)


def _from_the_start(
    time_s: np.ndarray,
    sin_theta: np.ndarray,
    drive_time_s: np.ndarray,
    push: np.ndarray,
    coarse: LagEstimate,
    frame_s: float,
) -> LagEstimate | None:
    """The lag from how the body leaves its rest at the drive's first step; None without a rest or a step in view.

    Until its stiffness is felt, the body follows the second or third integral of the drive (a force on a mass,
    or one that itself grows); the interval holds what any of them that is not far worse allows.
    """
    if len(np.unique(np.round(push, 2))) > MOST_LEVELS:
        return None  # a drive that grows slowly leaves open when the body began
    change = int(np.argmax(np.abs(push - push[0]) > LEAST_CHANGE * np.ptp(push)))
    begins = drive_time_s[change] + coarse.lag_s - coarse.uncertainty_s
    seen = np.isfinite(sin_theta)
    rest = seen & (time_s > begins - REST_S) & (time_s < begins)
    if rest.sum() < REST_FRAMES:
        return None
    line = np.polyfit(time_s[rest] - begins, sin_theta[rest], 1 if rest.sum() >= 2 * REST_FRAMES else 0)
    away = np.abs(sin_theta - np.polyval(line, time_s - begins))
    after = seen & (time_s >= begins) & (time_s < begins + 2.0 * coarse.uncertainty_s + FIRST_SWING_S)
    if after.sum() < REST_FRAMES:
        return None
    reached = time_s[after][np.argmax(away[after] > FIRST_SHARE * away[after].max())]
    used = seen & (time_s > begins - REST_S) & (time_s <= reached)
    when, angle = time_s[used], sin_theta[used]
    lags = coarse.lag_s + np.arange(-1.2 * coarse.uncertainty_s, 1.2 * coarse.uncertainty_s, frame_s / 8)
    fine = np.arange(drive_time_s[change], when[-1] - lags[0] + frame_s, frame_s / 8)
    pushed = push[row_in_force(drive_time_s, fine + 1e-9)] - push[0]
    losses = []
    response = pushed
    for order in (1, 2, 3):
        response = np.cumsum(response) * frame_s / 8
        if order > 1:
            losses.append(
                [_start_loss(when, angle, np.interp(when - lag, fine, response, left=0.0)) for lag in lags]
            )
    loss = np.array(losses)
    least = loss.min(axis=1, keepdims=True)
    as_good = loss < least * (1.0 + INTERVAL_LOSS / max(len(when) - 5, 3))
    allowed = lags[(as_good & (least < MODEL_LOSS * least.min())).any(axis=0)]
    low, high = allowed.min() - MODEL_FRAMES * frame_s, allowed.max() + MODEL_FRAMES * frame_s
    return LagEstimate(float(0.5 * (low + high)), float(0.5 * (high - low)), coarse.gain)


def _start_loss(when: np.ndarray, angle: np.ndarray, response: np.ndarray) -> float:
    """What a line and so much of the response leave of the angle."""
    design = np.column_stack([np.ones(len(when)), when - when[0], response / max(response.max(), 1e-300)])
    left = angle - design @ np.linalg.lstsq(design, angle, rcond=None)[0]
    return float(left @ left)
