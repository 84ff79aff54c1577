"""What was heard, as recordings to fit."""

from collections import deque

import numpy as np
from hasel_recording import Recording

from hasel_sysid.errors import SysidError
from hasel_sysid.live.driven_parts import driven_parts

_FEWEST_FRAMES = 20
_MOST_MESSAGES = 400_000
"""Of one topic in one run; about an hour. Older ones are forgotten."""


class _Series:
    def __init__(self, epoch: int) -> None:
        self.epoch = epoch
        self.stamps: list[int] = []
        self.values: list = []

    def add(self, stamp_ns: int, value) -> None:
        if not self.stamps or stamp_ns > self.stamps[-1]:
            self.stamps.append(stamp_ns)
            self.values.append(value)
        if len(self.stamps) > _MOST_MESSAGES:
            del self.stamps[: _MOST_MESSAGES // 10], self.values[: _MOST_MESSAGES // 10]


class Heard:
    """Collects states and measured angles run by run.

    reset: a longer gap [s] begins a new run, as in the simulator; runs: how many are kept.
    """

    def __init__(self, reset: float, runs: int = 50) -> None:
        self._reset_ns = reset * 1e9
        self._states: deque[_Series] = deque(maxlen=runs)
        self._angles: deque[_Series] = deque(maxlen=runs)

    def state(self, epoch: int, stamp_ns: int, voltage: tuple[float, float]) -> None:
        """A commanded voltage [V] that holds from its stamp [ns] on; one that is not known (NaN) is left out."""
        if np.isfinite(voltage).all():
            self._series(self._states, epoch, stamp_ns).add(stamp_ns, voltage)

    def measured(self, epoch: int, stamp_ns: int, sin_theta: float) -> None:
        """A measured angle; NaN in a frame without."""
        self._series(self._angles, epoch, stamp_ns).add(stamp_ns, sin_theta)

    def clear(self) -> None:
        """Forget everything."""
        self._states.clear()
        self._angles.clear()

    def recordings(self) -> list[Recording]:
        """One per run that was both driven and measured, oldest first, each beginning at 0 s.

        A run is cut where nothing is driven for long (`driven_parts`). Raises SysidError when there is none.
        """
        complete = [recording for angles in self._angles for recording in self._recordings(angles)]
        if not complete:
            raise SysidError(
                f"no run was heard so far, expected states and at least {_FEWEST_FRAMES} measured angles: replay or "
                "measure one first, or name recordings"
            )
        return complete

    def _series(self, kept: deque[_Series], epoch: int, stamp_ns: int) -> _Series:
        last = kept[-1] if kept else None
        if last is None or last.epoch != epoch or stamp_ns - last.stamps[-1] > self._reset_ns:
            kept.append(_Series(epoch))
        return kept[-1]

    def _recordings(self, angles: _Series) -> list[Recording]:
        """The runs of some angles, with the states that overlap them most."""

        def overlap(states: _Series) -> int:
            return min(states.stamps[-1], angles.stamps[-1]) - max(states.stamps[0], angles.stamps[0])

        same = [states for states in self._states if states.epoch == angles.epoch]
        states = max(same, key=overlap, default=None)
        if states is None or overlap(states) <= 0:
            return []
        origin = min(states.stamps[0], angles.stamps[0])
        drive = _seconds(states.stamps, origin), np.array(states.values, dtype=float)
        measured = _seconds(angles.stamps, origin), np.array(angles.values, dtype=float)
        end = max(drive[0][-1], measured[0][-1])
        parts = [_part(origin, drive, measured, begin, stop) for begin, stop in driven_parts(*drive, end)]
        return [part for part in parts if len(part.time_s) >= _FEWEST_FRAMES]


def _seconds(stamps: list[int], origin: int) -> np.ndarray:
    return (np.array(stamps) - origin) * 1e-9


def _part(origin: int, drive: tuple, measured: tuple, begin: float, stop: float) -> Recording:
    """What happened from `begin` to `stop` [s], counted from `begin`."""
    (drive_time, drive_voltage), (time, sin_theta) = drive, measured
    driven, seen = (begin <= drive_time) & (drive_time <= stop), (begin <= time) & (time <= stop)
    in_force = np.searchsorted(drive_time, time[seen], side="right") - 1
    voltage = np.where(in_force[:, None] >= 0, drive_voltage[np.maximum(in_force, 0)], 0.0)
    passive = not drive_voltage[driven].any()
    return Recording(
        f"heard_{origin * 1e-9 + begin:.1f}s",
        time[seen] - begin,
        sin_theta[seen],
        None if passive else voltage,
        drive_time_s=None if passive else drive_time[driven] - begin,
        drive_values=None if passive else drive_voltage[driven],
    )
