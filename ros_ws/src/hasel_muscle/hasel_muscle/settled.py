# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From samples to settled frames: the law is one of balance, so what still rings or flows is left out."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from hasel_sim.muscle.muscle import Muscle
from hasel_sysid.errors import SysidError

from hasel_muscle.bench_recording import BenchRecording, Held

_FRAME_S = 0.1
"""Samples are gathered in frames as long as this, unless they are farther apart."""
_SAME = 0.01
"""Voltages that differ by less than this share of the highest are one."""
_FEWEST_FRAMES = 5
_TO_SIGMA = 1.4826
_MEDIAN = np.sqrt(np.pi / 2)
"""Standard error of a median by that of a mean, of normal numbers."""


@dataclass(frozen=True)
class SettledRun:
    """Frames at times [s] [n] with voltage [V], contraction [m] from the rest before the first lift, and load [N].

    used [n]: which of them are settled and measured; hold [n]: number of the stretch of constant voltage; level [n]:
    its magnitude [V], at rest that of the lift before. noise: standard deviation of a frame, zero_error: of what was
    called zero, which all frames share, both in metres or newtons.
    """

    name: str
    held: Held
    time: np.ndarray
    voltage: np.ndarray
    contraction: np.ndarray
    load: np.ndarray
    used: np.ndarray
    hold: np.ndarray
    level: np.ndarray
    rest_load: float
    noise: float
    noise_source: str
    zero_error: float = 0.0

    @property
    def measured(self) -> np.ndarray:
        """The muscle's answer in the frames that count, [used]: contraction [m], or force [N] where that is held."""
        return (self.contraction if self.held == "load" else self.load)[self.used]

    @property
    def kept(self) -> np.ndarray:
        """What the bench keeps, in the same frames, [used]: load [N], or contraction [m]."""
        return (self.load if self.held == "load" else self.contraction)[self.used]

    @property
    def unit(self) -> str:
        """Of `measured`."""
        return "m" if self.held == "load" else "N"

    def predicted(self, muscle: Muscle) -> np.ndarray:
        """The same by the law, [used]."""
        if self.held == "load":
            return muscle.contraction(self.time, self.voltage, self.load, self.rest_load, self.used)
        return muscle.force(self.time, self.voltage, self.contraction, self.rest_load, self.used)


def settled(recording: BenchRecording, settling: float = 1.0) -> SettledRun:
    """Gather the frames; one counts when the voltage has not changed for `settling` [s].

    Raises SysidError for a recording in which the voltage is never held long enough.
    """
    time, voltage, spread, contraction, load = _frames(recording)
    same = _SAME * float(np.abs(voltage).max())
    hold = _holds(voltage, spread, same)
    first = np.concatenate([[True], np.diff(hold) != 0])
    since = time - np.maximum.accumulate(np.where(first, time, -np.inf))
    at_rest = np.abs(voltage) <= same
    before = at_rest & (hold == hold[0])
    used = (since >= settling - 1e-9) & (spread <= same) | before
    answer = contraction if recording.held == "load" else load
    used &= np.isfinite(answer) & np.isfinite(contraction) & np.isfinite(load)
    if not np.any(used & ~at_rest):
        raise SysidError(
            f"{recording.name}: the voltage never stays for {settling:g} s and more, and the law is one of balance; "
            "expected lifts that are held: record steps (the preset three_lifts), or lower --settling"
        )
    resting = before & np.isfinite(contraction)
    is_zeroed = recording.held == "load" and resting.any()
    zero = float(np.median(contraction[resting])) if is_zeroed else 0.0
    noise, source = _noise(answer, before & used, used, hold)
    return SettledRun(
        name=recording.name,
        held=recording.held,
        time=time,
        voltage=np.where(at_rest, 0.0, voltage),
        contraction=_filled(time, contraction - zero),
        load=_filled(time, load),
        used=used,
        hold=hold,
        level=_levels(voltage, at_rest, hold),
        rest_load=float(np.nanmedian(load[before])) if before.any() else 0.0,
        noise=noise,
        noise_source=source,
        zero_error=_MEDIAN * noise / np.sqrt(resting.sum()) if is_zeroed else 0.0,
    )


def _filled(time: np.ndarray, series: np.ndarray) -> np.ndarray:
    """Gaps bridged by straight lines: no frame of them counts, but the muscle's history runs through them."""
    known = np.isfinite(series)
    return np.interp(time, time[known], series[known]) if known.any() else np.zeros(len(time))


def _frames(recording: BenchRecording) -> tuple[np.ndarray, ...]:
    """Time, voltage, its spread, contraction and load of every frame: medians, which no single wild sample moves."""
    step = float(np.median(np.diff(recording.time)))
    width = max(_FRAME_S, step)
    number = np.floor(recording.time / width + 1e-9).astype(int)
    starts = np.flatnonzero(np.concatenate([[True], np.diff(number) > 0]))
    ends = [*starts[1:], len(number)]

    def gathered(series: np.ndarray, how: Callable[[np.ndarray], np.floating]) -> np.ndarray:
        parts = (series[a:b] for a, b in zip(starts, ends, strict=True))
        known = (part[np.isfinite(part)] for part in parts)
        return np.array([how(part) if len(part) else np.nan for part in known])

    voltage = gathered(recording.voltage, np.median)
    series = (gathered(each, np.median) for each in (recording.contraction, recording.load))
    return recording.time[starts], voltage, gathered(recording.voltage, np.ptp), *series


def _holds(voltage: np.ndarray, spread: np.ndarray, same: float) -> np.ndarray:
    """Number of the stretch of constant voltage that each frame is in, [n]."""
    hold = np.zeros(len(voltage), dtype=int)
    reference = voltage[0]
    for i in range(1, len(voltage)):
        new = abs(voltage[i] - reference) > same
        hold[i] = hold[i - 1] + new
        if new or spread[i] > same:
            reference = voltage[i]
    return hold


def _levels(voltage: np.ndarray, at_rest: np.ndarray, hold: np.ndarray) -> np.ndarray:
    """Magnitude [V] of every hold, [n]; a rest belongs to the lift before it, the first one to none (0)."""
    level, last = np.zeros(len(voltage)), 0.0
    for number in np.unique(hold):
        frames = hold == number
        if not at_rest[frames].all():
            last = float(f"{np.median(np.abs(voltage[frames])):.3g}")
        level[frames] = last
    return level


def _noise(answer: np.ndarray, resting: np.ndarray, used: np.ndarray, hold: np.ndarray) -> tuple[float, str]:
    """Standard deviation of a frame, and where it comes from: the largest seen, as few frames tell little."""
    found: list[tuple[float, str]] = []
    if resting.sum() >= _FEWEST_FRAMES:
        found.append((float(np.std(answer[resting], ddof=1)), f"{resting.sum()} frames at rest"))
    pairs = used[1:] & used[:-1] & (np.diff(hold) == 0)
    steps = np.diff(answer)[pairs]
    if len(steps) >= _FEWEST_FRAMES:
        spread = _TO_SIGMA * float(np.median(np.abs(steps - np.median(steps)))) / np.sqrt(2)
        found.append((spread, f"differences of {len(steps)} neighbouring frames"))
    apart = np.diff(np.unique(answer[used]))
    if found and len(apart):
        found.append((float(apart.min()) / np.sqrt(12), "the sensor's steps"))
    return max(found, default=(float("nan"), "too few frames"))
