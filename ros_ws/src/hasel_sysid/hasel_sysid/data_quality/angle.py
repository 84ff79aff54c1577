# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults of the measured angle and of the markers that it comes from."""

import numpy as np
from hasel_recording import Recording, sin_theta_from_markers
from scipy.ndimage import median_filter

from hasel_sysid.data_quality.finding import DataFinding, error, warning
from hasel_sysid.residual_analysis.drive_cycle import cycle_of
from hasel_sysid.residual_analysis.robust_statistics import high_frequency_noise

_MANY_LOST = 0.2
_FROZEN_S = 0.2
_JUMP_IN_NOISE = 12.0
_JUMP_IN_STEPS = 1.2
_USUAL_STEPS = 0.9
"""A jump goes further than nine tenths of the steps between frames: a fast swing, or a slow camera, is no jump."""
_SMALLEST_JUMP = 0.05
_LEAST_MOTION_IN_NOISE = 10.0
_FRAMES_PER_CYCLE = 8
_LONGEST_BODY_M = 3.0
_JUMP_IN_BODIES = 0.3


def check_angle(recording: Recording) -> list[DataFinding]:
    """Faults of sin theta alone."""
    sin_theta = recording.sin_theta[recording.valid]
    lost = _lost(recording)
    if len(sin_theta) < 16:
        return lost
    unit = _angle_unit(sin_theta)
    return lost + (unit or [*_frozen(recording), *_jumps(sin_theta), *_motion(recording, sin_theta)])


def _lost(recording: Recording) -> list[DataFinding]:
    share = 1.0 - float(recording.valid.mean())
    if share == 0:
        return []
    make = error if share > _MANY_LOST else warning
    evidence = f"{share:.1%} of the frames have no angle (NaN)"
    return [make("lost frames", share, evidence, "look at the markers' colour and light in the video")]


def _angle_unit(sin_theta: np.ndarray) -> list[DataFinding]:
    largest = float(np.abs(sin_theta).max())
    outside = float(np.mean(np.abs(sin_theta) > 1.0))
    if outside < 0.01:
        return []
    unit = "radians" if largest <= np.pi / 2 + 0.01 else "degrees"
    evidence = f"sin_theta reaches {largest:.3g}, a sine ends at 1"
    return [error("unit of the angle", largest, evidence, f"give its sine; is it the angle in {unit}?")]


def _frozen(recording: Recording) -> list[DataFinding]:
    values, time = recording.sin_theta, recording.time_s
    starts = np.flatnonzero(np.concatenate([[True], values[1:] != values[:-1]]))
    ends = np.append(starts[1:], len(values)) - 1
    length = np.where(values[starts] != 0, time[ends] - time[starts], 0.0)
    longest = float(length.max())
    if longest < _FROZEN_S:
        return []
    evidence = f"the angle keeps exactly one value for {longest:.2f} s"
    advice = "the camera or the tracker stood still: record again or cut the run there"
    make = error if longest > 0.2 * recording.duration_s else warning
    return [make("frozen angle", longest, evidence, advice)]


def _jumps(sin_theta: np.ndarray) -> list[DataFinding]:
    usual = median_filter(sin_theta, size=5, mode="nearest")
    apart = np.abs(sin_theta - usual)
    step = float(np.quantile(np.abs(np.diff(sin_theta)), _USUAL_STEPS))
    limit = max(_JUMP_IN_NOISE * high_frequency_noise(sin_theta), _JUMP_IN_STEPS * step, _SMALLEST_JUMP)
    jumps = int(np.count_nonzero(apart > limit))
    if jumps == 0:
        return []
    evidence = f"the angle jumps for a moment in {jumps} frames, by more than {limit:.2g}"
    return [warning("jumping marker", jumps, evidence, "another object is taken for a marker: cover it")]


def _motion(recording: Recording, sin_theta: np.ndarray) -> list[DataFinding]:
    if _too_fast_to_tell(recording):
        return []
    noise = high_frequency_noise(sin_theta)
    span = float(np.subtract(*np.percentile(sin_theta, [98, 2])))
    if noise == 0 and span > 0:
        return []
    ratio = span / noise if noise > 0 else 0.0
    if ratio >= _LEAST_MOTION_IN_NOISE:
        return []
    evidence = f"the body moves by {ratio:.1f} times the noise"
    advice = "drive it harder or nearer to its resonance, and check that the muscles are connected"
    return [(error if ratio < 6 else warning)("too little excitation", ratio, evidence, advice)]


def _too_fast_to_tell(recording: Recording) -> bool:
    """Whether the drive repeats within so few frames that the motion cannot be told from the noise of single frames."""
    if not recording.driven:
        return False
    cycle = cycle_of(recording)
    frame = float(np.median(np.diff(recording.time_s)))
    return cycle is not None and cycle.period < _FRAMES_PER_CYCLE * frame


def check_markers(recording: Recording) -> list[DataFinding]:
    """Faults of recorded markers; none where head, middle and tail were not."""
    three = recording.angle_markers
    if three is None:
        return []
    seen = np.isfinite(three).all(axis=(1, 2))
    if np.count_nonzero(seen) < 8:
        return []
    markers = three[seen] * ((1, -1) if recording.marker_unit == "px" else (1, 1))
    return _marker_unit(markers, recording.marker_unit) + (
        _middle(markers) or [*_exchanged(markers), *_fits_the_markers(markers, recording.sin_theta[seen])]
    )


def _vectors(markers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return markers[:, 1] - markers[:, 0], markers[:, 2] - markers[:, 1]


def _length(markers: np.ndarray) -> float:
    return float(np.median(sum(np.linalg.norm(vector, axis=1) for vector in _vectors(markers))))


def _marker_unit(markers: np.ndarray, unit: str) -> list[DataFinding]:
    length = _length(markers)
    if unit != "m" or length < _LONGEST_BODY_M:
        return []
    evidence = f"head and tail are {length:.3g} m apart"
    return [error("unit of the markers", length, evidence, "give metres; are they in millimetres?")]


def _middle(markers: np.ndarray) -> list[DataFinding]:
    first, second = _vectors(markers)
    outside = float(np.mean((first * second).sum(axis=1) < 0))
    if outside < 0.01:
        return []
    far = np.linalg.norm(first, axis=1).mean() > np.linalg.norm(second + first, axis=1).mean()
    evidence = f"the middle marker is not between the others in {outside:.0%} of the frames"
    other = "tail" if far else "head"
    return [error("marker swap", outside, evidence, f"middle and {other} seem exchanged: track them again")]


def _exchanged(markers: np.ndarray) -> list[DataFinding]:
    steps = np.linalg.norm(np.diff(markers, axis=0), axis=2).max(axis=1)
    jumps = int(np.count_nonzero(steps > _JUMP_IN_BODIES * _length(markers)))
    if jumps == 0:
        return []
    evidence = f"markers leap more than {_JUMP_IN_BODIES:.0%} of the body {jumps} times from frame to frame"
    return [error("marker swap", jumps, evidence, "markers change places during the run: track them again")]


def _fits_the_markers(markers: np.ndarray, sin_theta: np.ndarray) -> list[DataFinding]:
    own = sin_theta_from_markers(markers)
    both = np.isfinite(own) & np.isfinite(sin_theta)
    own, said = own[both], sin_theta[both]
    if len(own) < 8 or np.ptp(own) < 1e-6 or np.ptp(said) == 0:
        return []
    ratio = float(np.polyfit(own, said, 1)[0])
    apart = float(np.median(np.abs(own - said)))
    if apart < 0.01 * max(1e-6, float(np.ptp(own))) or apart < 1e-4:
        return []
    evidence = f"sin_theta is {ratio:.3g} times what the markers give"
    if ratio < -0.5:
        return [error("sign flip", ratio, evidence, "head and tail or the image's sides are exchanged")]
    if 45 < ratio < 70:
        return [error("unit of the angle", ratio, evidence, "give its sine; is it the angle in degrees?")]
    return [warning("angle does not fit the markers", ratio, evidence, "compute it from these markers")]
