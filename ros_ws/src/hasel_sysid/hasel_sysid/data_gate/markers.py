"""Faults of the marker positions: unit, markers taken for one another, an angle that does not fit them."""

import numpy as np
from hasel_recording import Recording, sin_theta_from_markers

from hasel_sysid.data_gate.finding import DataFinding, error, warning

_LONGEST_BODY_M = 3.0
_JUMP_IN_BODIES = 0.3


def check_markers(recording: Recording) -> list[DataFinding]:
    """Faults of recorded markers; none where head, middle and tail were not."""
    three = recording.angle_markers
    if three is None:
        return []
    seen = np.isfinite(three).all(axis=(1, 2))
    if np.count_nonzero(seen) < 8:
        return []
    markers = three[seen] * ((1, -1) if recording.marker_unit == "px" else (1, 1))
    return _unit(markers, recording.marker_unit) + (
        _middle(markers) or [*_exchanged(markers), *_angle(markers, recording.sin_theta[seen])]
    )


def _vectors(markers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return markers[:, 1] - markers[:, 0], markers[:, 2] - markers[:, 1]


def _length(markers: np.ndarray) -> float:
    return float(np.median(sum(np.linalg.norm(vector, axis=1) for vector in _vectors(markers))))


def _unit(markers: np.ndarray, unit: str) -> list[DataFinding]:
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


def _angle(markers: np.ndarray, sin_theta: np.ndarray) -> list[DataFinding]:
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
