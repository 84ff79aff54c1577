"""What was heard, as recordings to fit."""

from collections import deque

import numpy as np
from hasel_recording import Recording

from hasel_sysid.errors import SysidError

_FEWEST_FRAMES = 20


class _Series:
    def __init__(self, epoch: int) -> None:
        self.epoch = epoch
        self.stamps: list[int] = []
        self.values: list = []

    def add(self, stamp_ns: int, value) -> None:
        if not self.stamps or stamp_ns > self.stamps[-1]:
            self.stamps.append(stamp_ns)
            self.values.append(value)


class Heard:
    """Collects states and measured angles run by run.

    reset: a longer gap [s] begins a new run, as in the simulator; runs: how many are kept.
    """

    def __init__(self, reset: float, runs: int = 50) -> None:
        self._reset_ns = reset * 1e9
        self._states: deque[_Series] = deque(maxlen=runs)
        self._angles: deque[_Series] = deque(maxlen=runs)

    def state(self, epoch: int, stamp_ns: int, voltage: tuple[float, float]) -> None:
        """A commanded voltage [V] that holds from its stamp [ns] on."""
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

        Raises SysidError when there is none.
        """
        found = [self._recording(angles) for angles in self._angles if len(angles.stamps) >= _FEWEST_FRAMES]
        complete = [recording for recording in found if recording is not None]
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

    def _recording(self, angles: _Series) -> Recording | None:
        """The run of some angles, with the states that overlap them most."""

        def overlap(states: _Series) -> int:
            return min(states.stamps[-1], angles.stamps[-1]) - max(states.stamps[0], angles.stamps[0])

        same = [states for states in self._states if states.epoch == angles.epoch]
        states = max(same, key=overlap, default=None)
        if states is None or overlap(states) <= 0:
            return None
        origin = min(states.stamps[0], angles.stamps[0])
        drive_time = (np.array(states.stamps) - origin) * 1e-9
        drive_voltage = np.array(states.values, dtype=float)
        time = (np.array(angles.stamps) - origin) * 1e-9
        in_force = np.searchsorted(drive_time, time, side="right") - 1
        voltage = np.where(in_force[:, None] >= 0, drive_voltage[np.maximum(in_force, 0)], 0.0)
        passive = not drive_voltage.any()
        return Recording(
            f"heard_{angles.stamps[0] * 1e-9:.1f}s",
            time,
            np.array(angles.values, dtype=float),
            None if passive else voltage,
            drive_time_s=None if passive else drive_time,
            drive_voltage=None if passive else drive_voltage,
        )
