# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What was heard, as recordings to fit: a long stream of the supply's states and measured angles, cut into runs."""

from collections import deque
from collections.abc import Sequence
from datetime import datetime
from typing import Any, NamedTuple

import numpy as np
from hasel_recording import Recording
from hasel_recording.recording import held

from hasel_sysid.errors import SysidError

REST_S = 2.0
"""After this long at 0 V the body is at rest."""
_BEFORE_S, AFTER_S = 0.25, 1.0
"""Of the rest, so much is kept around what is driven: the start, and the ringing."""
_FEWEST_FRAMES = 20
_MOST_MESSAGES = 400_000
"""Of one topic in one run; about an hour. Older ones are forgotten."""
_A_CLOCKS = 1e9
"""Stamps [s] below are counted from the start of something, not from 1970."""


def driven_parts(time: np.ndarray, voltage: np.ndarray, end: float) -> list[tuple[float, float]]:
    """Begin and end [s] of the stretches between long rests.

    time [s] [n], voltage [V] [n, 2], each holding until the next; end [s] of the stream. A body that is never driven
    swings by itself: it is one stretch.
    """
    on = voltage.any(axis=1)
    if not on.any():
        return [(float(time[0]), end)]
    switched = np.flatnonzero(np.diff(np.concatenate([[False], on, [False]]).astype(int)))
    edges = np.append(time, end)[switched].reshape(-1, 2)
    parts = [list(edges[0])]
    for begin, stop in edges[1:]:
        if begin - parts[-1][1] > REST_S:
            parts.append([begin, stop])
        else:
            parts[-1][1] = stop
    first = float(time[0])
    return [(max(first, begin - _BEFORE_S), min(end, stop + AFTER_S)) for begin, stop in parts]


class DriveWatch:
    """Told of states one after the other, as `driven_parts` cuts the whole stream; a voltage holds until the next."""

    def __init__(self) -> None:
        self._epoch: int | None = None
        self._driven = False
        self._resting_since_ns = 0
        self._last_rest_ns: tuple[float, float] | None = None

    def begins(self, epoch: int, stamp_ns: int, voltage: Sequence[float]) -> bool:
        """Whether a run begins with this state; a voltage [V] that is not known (NaN) drives nothing."""
        if epoch != self._epoch:
            self._epoch, self._driven = epoch, False
            self._resting_since_ns, self._last_rest_ns = stamp_ns, None
        was_driven, self._driven = self._driven, any(abs(each) > 0 for each in voltage)
        if was_driven and not self._driven:
            self._resting_since_ns, self._last_rest_ns = stamp_ns, (stamp_ns, float("inf"))
        if was_driven or not self._driven:
            return False
        if self._last_rest_ns is not None:
            self._last_rest_ns = self._resting_since_ns, stamp_ns
        return stamp_ns - self._resting_since_ns > REST_S * 1e9

    def is_over(self, epoch: int, stamp_ns: int) -> bool:
        """Whether the body, once driven, has come to rest by a stamp [ns], which may lie before the last state."""
        if epoch != self._epoch or self._last_rest_ns is None:
            return False
        since_ns, until_ns = self._last_rest_ns
        return since_ns + AFTER_S * 1e9 < stamp_ns < until_ns


class _Series:
    """unknown_from: the stamp [ns] since which nothing is known, None where the last value still holds."""

    def __init__(self, epoch: int) -> None:
        self.epoch = epoch
        self.unknown_from: int | None = None
        self.stamps: list[int] = []
        self.values: list[Any] = []

    def add(self, stamp_ns: int, value: Any) -> None:
        if not self.stamps or stamp_ns > self.stamps[-1]:
            self.stamps.append(stamp_ns)
            self.values.append(value)
            self.unknown_from = None
        if len(self.stamps) > _MOST_MESSAGES:
            del self.stamps[: _MOST_MESSAGES // 10], self.values[: _MOST_MESSAGES // 10]


_Sampled = tuple[np.ndarray, np.ndarray]
"""Times [s] [n] and what was then."""


class _Run(NamedTuple):
    recording: Recording
    has_ended: bool


class Heard:
    """Collects states and measured angles run by run.

    reset: a longer gap [s] begins a new run, as in the simulator; runs: how many are kept.
    """

    def __init__(self, reset: float, runs: int = 50) -> None:
        self._reset_ns = reset * 1e9
        self._states: deque[_Series] = deque(maxlen=runs)
        self._angles: deque[_Series] = deque(maxlen=runs)

    def state(self, epoch: int, stamp_ns: int, voltage: tuple[float, float]) -> None:
        """A commanded voltage [V] that holds from its stamp [ns] on; one that is not known for a moment (NaN), too."""
        if np.isfinite(voltage).all():
            self._series(self._states, epoch, stamp_ns).add(stamp_ns, voltage)
        elif self._states and self._states[-1].unknown_from is None:
            self._states[-1].unknown_from = stamp_ns

    def measured(self, epoch: int, stamp_ns: int, sin_theta: float) -> None:
        """A measured angle; NaN in a frame without."""
        self._series(self._angles, epoch, stamp_ns).add(stamp_ns, sin_theta)

    def clear(self) -> None:
        """Forget everything."""
        self._states.clear()
        self._angles.clear()

    def recordings(self, ended: bool = False) -> list[Recording]:
        """One per run that was both driven and measured, oldest first, each beginning at 0 s.

        A run is cut where nothing is driven for long (`driven_parts`). ended: without one that is going on. Raises
        SysidError when there is none.
        """
        runs = [run for angles in self._angles for run in self._runs(angles)]
        runs = [run for run in runs if len(run.recording.time_s) >= _FEWEST_FRAMES]
        if not runs:
            raise SysidError(
                f"no run was heard so far, expected states and at least {_FEWEST_FRAMES} measured angles: replay or "
                "measure one first, or name recordings"
            )
        complete = [run.recording for run in runs if run.has_ended or not ended]
        if not complete:
            raise SysidError(
                "no run that was heard has ended so far, expected one that was driven: it ends a second after the drive"
            )
        return complete

    def _series(self, kept: deque[_Series], epoch: int, stamp_ns: int) -> _Series:
        last = kept[-1] if kept else None
        if last is None or last.epoch != epoch or stamp_ns - last.stamps[-1] > self._reset_ns:
            kept.append(_Series(epoch))
        return kept[-1]

    def _runs(self, angles: _Series) -> list[_Run]:
        """What was driven while some angles came; where nothing was at all, the body by itself.

        The states may have ceased meanwhile, as they do while a supply does not know its voltage.
        """
        met = [run for states in self._states for run in _met(states, angles, self._reset_ns)]
        return [run for run in met if run.recording.driven] or met


def _seconds(stamps: list[int], origin: int) -> np.ndarray:
    return (np.array(stamps) - origin) * 1e-9


def _met(states: _Series, angles: _Series, reset_ns: float) -> list[_Run]:
    """The runs in the time that states and angles share; a state holds no longer than `reset_ns`."""
    known_until = states.stamps[-1] + reset_ns if states.unknown_from is None else states.unknown_from
    if (
        states.epoch != angles.epoch
        or known_until <= angles.stamps[0]
        or angles.stamps[-1] <= states.stamps[0]
    ):
        return []
    origin = min(states.stamps[0], angles.stamps[0])
    drive = _seconds(states.stamps, origin), np.array(states.values, dtype=float)
    measured = _seconds(angles.stamps, origin), np.array(angles.values, dtype=float)
    end = min(max(drive[0][-1], measured[0][-1]), (known_until - origin) * 1e-9)
    return [
        _Run(_part(origin, drive, measured, begin, stop), stop < end or states.unknown_from is not None)
        for begin, stop in driven_parts(*drive, end)
    ]


def _part(origin: int, drive: _Sampled, measured: _Sampled, begin: float, stop: float) -> Recording:
    """What happened from `begin` to `stop` [s], counted from `begin`."""
    (drive_time, drive_voltage), (time, sin_theta) = drive, measured
    driven, seen = (begin <= drive_time) & (drive_time <= stop), (begin <= time) & (time <= stop)
    voltage = held(drive_time, drive_voltage, time[seen])
    passive = not drive_voltage[driven].any()
    return Recording(
        _name(origin * 1e-9 + begin),
        time[seen] - begin,
        sin_theta[seen],
        None if passive else voltage,
        drive_time_s=None if passive else drive_time[driven] - begin,
        drive_values=None if passive else drive_voltage[driven],
    )


def _name(stamp: float) -> str:
    """Of a run that begins at a stamp [s]: in local time, as the driver names its recordings, unless no clock ran."""
    if stamp < _A_CLOCKS:
        return f"heard_{stamp:.1f}s"
    return f"heard_{datetime.fromtimestamp(stamp):%Y-%m-%d_%H-%M-%S}"
