# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Checks that need what a model predicts for the same command."""

import numpy as np
from hasel_recording import Recording

from hasel_sysid.data_quality.finding import DataFinding, error, warning
from hasel_sysid.data_quality.recording_check import ordered
from hasel_sysid.residual_analysis.alignment import Alignment, align, explained_by
from hasel_sysid.residual_analysis.robust_statistics import high_frequency_noise
from hasel_sysid.residual_analysis.run_series import RunSeries, run_series

_CLEAR_LAG = 5.0
_LEAST_S = 0.004
_ALIKE = 0.9
_OPPOSITE = -0.5
_LONGEST_PHYSICAL_LAG_S = 0.1
_HARDLY_MORE = 1.5


def check_channel_lag(run: RunSeries, aligned: Alignment) -> list[DataFinding]:
    """Compare the lag after switches to the upper muscle with that after switches to the lower one."""
    if (
        run.cycle is None
        or len(run.channels) != 2
        or not (np.any(run.cycle.side > 0) and np.any(run.cycle.side < 0))
    ):
        return []
    _, side = run.cycle.since_switch(run.time - aligned.lag)
    fitted, size = explained_by(aligned, (-aligned.gain * aligned.rate * side)[:, None], run.frame_time)
    half, error = float(fitted.coefficients[0]), float(fitted.standard_errors[0])
    share = size**2 / max(float(np.mean(aligned.remainder**2)), 1e-30)
    if abs(half) < max(0.5 * _LEAST_S, _CLEAR_LAG * error) or share < 0.5:
        return []
    upper, lower = (aligned.lag + half) * 1e3, (aligned.lag - half) * 1e3
    evidence = (
        f"the angle lags {upper:.0f} ms behind the {run.channels[0].name} and {lower:.0f} ms behind the "
        f"{run.channels[1].name} command"
    )
    return [warning("channel lag", 2 * half, evidence, "compare the supply's channels with an oscilloscope")]


def check_against_model(
    recording: Recording, sin_theta: np.ndarray, markers: np.ndarray | None = None
) -> list[DataFinding]:
    """Faults that show against a simulation, errors first.

    sin_theta [n]: simulated at the recording's frames (NaN where not); markers [m] [n, 3, 2]: simulated, if recorded
    ones shall be compared.
    """
    drive = recording.drive() if recording.driven else None
    run = run_series(
        recording.name, recording.time_s, recording.sin_theta, sin_theta, drive, recording.channels
    )
    found = _lengths(recording, markers)
    if len(run.time) >= 16 and np.ptp(run.simulated) > 0 and np.ptp(run.measured) > 0:
        found += _same(run) or _sign(run) or _aligned(run)
    return ordered(recording.name, found)


def _same(run: RunSeries) -> list[DataFinding]:
    apart = float(np.abs(run.measured - run.simulated).max())
    if apart > 1e-9:
        return []
    evidence = "the measured angle is the simulated one to nine digits"
    return [warning("simulation equals measurement", apart, evidence, "check which signal was recorded")]


def _sign(run: RunSeries) -> list[DataFinding]:
    """Opposite over the whole run and from the very start, where resonance has not yet shifted any phase."""
    alike = float(np.corrcoef(run.measured, run.simulated)[0, 1])
    beginning = run.time <= (run.time[0] + 0.5 * run.cycle.period if run.cycle else np.inf)
    first = run.simulated[beginning] - run.simulated[0]
    start = run.measured[beginning] - np.median(run.measured[:3])
    scale = float(np.linalg.norm(first) * np.linalg.norm(start))
    at_start = float(first @ start) / scale if scale > 0 and run.cycle else alike
    if alike > _OPPOSITE or at_start > _OPPOSITE:
        return []
    evidence = f"measured and simulated angle have a correlation of {alike:.2f}"
    advice = "head and tail marker, the channels or the image's sides are exchanged: swap them back"
    return [error("sign flip or swapped channels", alike, evidence, advice)]


def _aligned(run: RunSeries) -> list[DataFinding]:
    aligned = align(run)
    alike = float(np.corrcoef(run.measured, aligned.shifted)[0, 1])
    if alike < _ALIKE:
        return []
    return _scale(aligned) or [*_lag(run, aligned), *check_channel_lag(run, aligned)]


def _scale(aligned: Alignment) -> list[DataFinding]:
    gain = aligned.gain
    if 1 / 8 < gain < 8:
        return []
    evidence = f"the measured angle is {gain:.3g} times the simulated one"
    if 40 < gain < 80:
        return [error("unit of the angle", gain, evidence, "give its sine; is it the angle in degrees?")]
    return [warning("scale of the angle", gain, evidence, "check units and calibration, or fit the model")]


def _lag(run: RunSeries, aligned: Alignment) -> list[DataFinding]:
    """A pure shift in time: it leaves hardly more than noise, which a lag of the body or the muscles would not."""
    lag, shift = aligned.components[2], float(np.std(aligned.remainder))
    pure = shift < _HARDLY_MORE * high_frequency_noise(run.measured)
    gross = lag.value > _LONGEST_PHYSICAL_LAG_S and shift < 0.5 * float(np.std(run.residual))
    if run.cycle is None or not (pure or gross):
        return []
    if abs(lag.value) < 0.5 * run.frame_time or lag.significance < 5:
        return []
    evidence = (
        f"the angle comes {abs(lag.value) * 1e3:.1f} ms {'before' if lag.value < 0 else 'after'} what the command "
        f"would give, and a shift in time takes the difference from {np.std(run.residual):.2g} to {shift:.2g} rms"
    )
    advice = "compare the clocks of supply and camera before looking for physics"
    impossible = lag.value < -1.5 * run.frame_time or lag.value > _LONGEST_PHYSICAL_LAG_S
    return [(error if impossible else warning)("command lag", lag.value, evidence, advice)]


def _lengths(recording: Recording, markers: np.ndarray | None) -> list[DataFinding]:
    if markers is None or recording.angle_markers is None:
        return []
    measured, simulated = _parts(recording.angle_markers), _parts(markers)
    share, expected = measured[0] / measured.sum(), simulated[0] / simulated.sum()
    if abs(share - expected) > 2 * abs(1 - share - expected) and abs(share - expected) > 0.01:
        evidence = f"the head marker's distance is {share:.0%} of the whole, {expected:.0%} expected"
        return [error("marker swap", share, evidence, "head and tail seem exchanged: track them again")]
    if recording.marker_unit == "m" and not 0.5 < measured.sum() / simulated.sum() < 2:
        ratio = float(measured.sum() / simulated.sum())
        evidence = f"the markers are {ratio:.3g} times as far apart as on the model"
        return [error("unit of the markers", ratio, evidence, "give metres, and choose the right model")]
    return []


def _parts(markers: np.ndarray) -> np.ndarray:
    """Median distances head to middle and middle to tail, [2]."""
    return np.nanmedian(np.linalg.norm(np.diff(markers, axis=1), axis=2), axis=0)
