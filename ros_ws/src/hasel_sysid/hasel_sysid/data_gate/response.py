"""Faults in how the angle answers the command: direction, a side that does not answer, clocks that differ."""

import numpy as np
from hasel_recording import HASEL_PAIR, Recording

from hasel_sysid.data_gate.finding import DataFinding, error, warning
from hasel_sysid.where_it_fails.drive_cycle import DriveCycle, comparable, drive_cycle
from hasel_sysid.where_it_fails.noise import high_frequency_noise

_REST_S = 0.025
_CLEAR = 6.0
_SMALLEST_MOTION = 0.01
_DEAD = 0.2
_LATE_S = 0.25


def check_response(recording: Recording) -> list[DataFinding]:
    """Faults in runs that start from rest; needs frames from the first switch on."""
    if recording.metadata.get("initial_state", "rest") != "rest":
        return []
    if not recording.driven:
        return []
    time, values = recording.drive()
    cycle = drive_cycle(time, comparable(values, recording.channels))
    valid = recording.valid
    time, sin_theta = recording.time_s[valid], recording.sin_theta[valid]
    if cycle is None or len(time) < 16 or time[0] > cycle.start + _REST_S:
        return []
    before = time < cycle.start + _REST_S
    noise = high_frequency_noise(sin_theta)
    moved = sin_theta - float(np.median(sin_theta[before]))
    limit = max(_CLEAR * noise, 0.02 * float(np.ptp(moved)))
    early = _early(time, moved, cycle, limit)
    if (
        early or recording.channels != HASEL_PAIR
    ):  # of other channels only the model knows which way they bend
        return early or _late(time, moved, cycle, limit)
    return [
        *_late(time, moved, cycle, limit),
        *_direction(time, moved, cycle, noise),
        *_sides(time, moved, cycle),
    ]


def _early(time: np.ndarray, moved: np.ndarray, cycle: DriveCycle, limit: float) -> list[DataFinding]:
    before = time < cycle.start
    if np.count_nonzero(before) < 4 or np.ptp(moved[before]) <= 2 * limit:
        return []
    started = time[before][np.argmax(np.abs(moved[before] - moved[0]) > limit)]
    early = float(cycle.start - started)
    evidence = f"the body moves {early * 1e3:.0f} ms before the first command"
    return [error("motion before command", early, evidence, "use one clock for the supply and the camera")]


def _late(time: np.ndarray, moved: np.ndarray, cycle: DriveCycle, limit: float) -> list[DataFinding]:
    moving = np.abs(moved) > limit
    lasting = moving[:-2] & moving[1:-1] & moving[2:]
    if not lasting.any():
        return []
    late = float(time[int(np.argmax(lasting))] - cycle.start)
    if late < _LATE_S:
        return []
    evidence = f"the body moves {late * 1e3:.0f} ms after the first command"
    return [warning("command lag", late, evidence, "use one clock for the supply and the camera")]


def _direction(time: np.ndarray, moved: np.ndarray, cycle: DriveCycle, noise: float) -> list[DataFinding]:
    first = (time >= cycle.start) & (time < cycle.switches[1])
    towards = cycle.side[0] * float(moved[first].mean()) if first.any() else 0.0
    if towards > -max(_CLEAR * noise, _SMALLEST_MOTION):
        return []
    muscle = "upper" if cycle.side[0] > 0 else "lower"
    evidence = f"the body first bends away from the {muscle} muscle, which is driven, by {-towards:.2g}"
    advice = "swap the channels, the head and tail marker, or the camera image's sides back"
    return [error("sign flip or swapped channels", -towards, evidence, advice)]


def _sides(time: np.ndarray, moved: np.ndarray, cycle: DriveCycle) -> list[DataFinding]:
    if not (np.any(cycle.side > 0) and np.any(cycle.side < 0)) or cycle.count(time) < 0.9:
        return []
    low, high = np.percentile(moved, [2, 98])
    reach = {"upper": float(high), "lower": float(-low)}
    weak = min(reach, key=reach.get)
    strong = max(reach.values())
    if strong < _SMALLEST_MOTION or reach[weak] > _DEAD * strong:
        return []
    evidence = f"the body bends {strong:.2g} to one side and {max(reach[weak], 0):.2g} to the {weak} side"
    advice = f"check cable, fuse and muscle of the {weak} channel"
    return [error("dead channel", reach[weak] / strong, evidence, advice)]
