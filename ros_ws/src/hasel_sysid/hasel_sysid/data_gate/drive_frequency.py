"""A drive whose frequency is not that of the response: a wrong name, gear or clock."""

import numpy as np
from hasel_recording import Recording

from hasel_sysid.data_gate.finding import DataFinding, error
from hasel_sysid.where_it_fails.drive_cycle import DriveCycle, comparable, drive_cycle

_HARMONICS = 6
_MANY_CYCLES, _LEAST_CYCLES = 8.0, 3.0
"""Cycles of the drive of which half may be left out, and without which nothing can be told."""
_PERIODIC, _NOT_AT_THE_DRIVES = 0.8, 0.5
"""Share of the variance that a response explains at its own frequency, and at the drive's at most, to be another."""
_RATIOS = np.arange(0.3, 3.0, 0.01)


def check_drive_frequency(recording: Recording) -> list[DataFinding]:
    """A response that repeats, but neither with the drive's period nor a whole part of it.

    A body that is driven periodically answers, once it has settled, with the drive's period. The first half of what is
    driven is left out, of a short run only the first cycle, and so is how the body swings by itself after it.
    """
    if not recording.driven:
        return []
    drive_time, values = recording.drive()
    cycle = drive_cycle(drive_time, comparable(values, recording.channels))
    if cycle is None or not _repeats(cycle):
        return []
    driven = recording.valid & (recording.time_s <= _end(drive_time, values))
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
