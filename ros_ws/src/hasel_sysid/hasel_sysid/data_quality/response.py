# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults in how the angle answers the command: direction, a dead side, clocks that differ, another frequency."""

import numpy as np
from hasel_recording import HASEL_PAIR, Recording

from hasel_sysid.data_quality.finding import DataFinding, error, warning
from hasel_sysid.residual_analysis.drive_cycle import DriveCycle, cycle_of
from hasel_sysid.residual_analysis.robust_statistics import high_frequency_noise

_REST_S = 0.025
_CLEAR = 6.0
_SMALLEST_MOTION = 0.01
_DEAD = 0.2
_LATE_S = 0.25
_HARMONICS = 6
_MANY_CYCLES, _LEAST_CYCLES = 8.0, 3.0
"""Cycles of the drive of which half may be left out, and without which nothing can be told."""
_PERIODIC, _NOT_AT_THE_DRIVES = 0.8, 0.5
"""Share of the variance that a response explains at its own frequency, and at the drive's at most, to be another."""
_RATIOS = np.arange(0.3, 3.0, 0.01)


def check_response(recording: Recording) -> list[DataFinding]:
    """Faults in runs that start from rest; needs frames from the first switch on."""
    if recording.metadata.get("initial_state", "rest") != "rest":
        return []
    if not recording.driven:
        return []
    cycle = cycle_of(recording)
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
    weak = min(reach, key=reach.__getitem__)
    strong = max(reach.values())
    if strong < _SMALLEST_MOTION or reach[weak] > _DEAD * strong:
        return []
    evidence = f"the body bends {strong:.2g} to one side and {max(reach[weak], 0):.2g} to the {weak} side"
    advice = f"check cable, fuse and muscle of the {weak} channel"
    return [error("dead channel", reach[weak] / strong, evidence, advice)]


def check_drive_frequency(recording: Recording) -> list[DataFinding]:
    """A response that repeats, but neither with the drive's period nor a whole part of it.

    A body that is driven periodically answers, once it has settled, with the drive's period. The first half of what is
    driven is left out, of a short run only the first cycle, and so is how the body swings by itself after it.
    """
    if not recording.driven:
        return []
    cycle = cycle_of(recording)
    if cycle is None or not _repeats(cycle):
        return []
    driven = recording.valid & (recording.time_s <= _end(*recording.drive()))
    time, sin_theta = recording.time_s[driven], recording.sin_theta[driven]
    if len(time) < 32:
        return []
    cycles = cycle.count(time)
    left_out = 0.5 * cycles if cycles >= _MANY_CYCLES else 1.0
    late = time >= max(cycle.start, time[0]) + left_out * cycle.period
    time, sin_theta = time[late], sin_theta[late]
    if len(time) < 32 or cycles < _LEAST_CYCLES or np.ptp(sin_theta) == 0:
        return []
    frequency = 1.0 / cycle.period
    at_the_drives = explained(time, sin_theta, frequency)
    if at_the_drives > _NOT_AT_THE_DRIVES:
        return []
    shares = np.array([explained(time, sin_theta, frequency * ratio) for ratio in _RATIOS])
    ratio = float(_RATIOS[_fundamental(shares)])
    if shares.max() < _PERIODIC:
        return []
    evidence = (
        f"the body beats at {ratio * frequency:.3g} Hz, {ratio:.2f} of the {frequency:.3g} Hz of the drive, which "
        f"explain {100 * at_the_drives:.0f} % of its motion"
    )
    advice = "check the recorded drive's clock, gear and name, or record the drive that acted"
    return [error("frequency of the drive", ratio, evidence, advice)]


def _end(time: np.ndarray, values: np.ndarray) -> float:
    """When the drive ends for good [s]; infinity where it does not."""
    after = int(np.flatnonzero(values.any(axis=1))[-1]) + 1
    return float(time[after]) if after < len(time) else np.inf


def _repeats(cycle: DriveCycle) -> bool:
    """Whether the take-overs come at a steady pace; a run of several frequencies has none of its own."""
    distances = np.diff(cycle.switches)
    return len(distances) < 3 or float(distances.max()) < 1.5 * float(np.median(distances))


def _fundamental(shares: np.ndarray) -> int:
    """The highest peak's that explains nearly as much as any: parts of its frequency explain it just as well."""
    padded = np.concatenate([[-np.inf], shares, [-np.inf]])
    peaks = (shares >= padded[:-2]) & (shares >= padded[2:])
    return int(np.flatnonzero(peaks & (shares >= shares.max() - 0.02))[-1])


def explained(time: np.ndarray, series: np.ndarray, frequency: float) -> float:
    """Share of a series' variance [1] that harmonics of a frequency [Hz] explain, at times [s] [n]."""
    phase = 2 * np.pi * frequency * (time - time[0])[:, None] * np.arange(1, _HARMONICS + 1)
    columns = np.concatenate([np.ones((len(time), 1)), np.cos(phase), np.sin(phase)], axis=1)
    rest = series - columns @ np.linalg.lstsq(columns, series, rcond=None)[0]
    return 1.0 - float(rest.var() / series.var())
