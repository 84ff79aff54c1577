# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is heard of a rig, for a page that draws it and for the session that fits it; no ROS is needed."""

import threading
from collections import deque
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
from hasel_recording import Recording, write_recording
from hasel_sysid.live.heard import Heard
from hasel_sysid.live.running_error import Epochs, Pair, Pairing, RunningError, RunningErrors, StreamEpoch

_LATE_S, _GAP_S, _RESET_S = 0.5, 0.1, 2.0
WINDOW_S = 5.0
"""Of the recent error."""
_KEPT = 20_000
"""Samples of each kind that wait to be drawn; some minutes."""
KINDS = ("measured", "simulated", "voltage")


class LiveStream:
    """Fed by any thread, read by any other. error: of the run going on, or of the last one as long as the body rests;
    None before a measured angle met a simulated one; count: samples of every kind so far.
    """

    def __init__(self) -> None:
        epochs = Epochs()
        self._epoch = {kind: StreamEpoch(epochs, _LATE_S) for kind in KINDS}
        self._samples: dict[str, deque[tuple[float, float, float]]] = {
            kind: deque(maxlen=_KEPT) for kind in KINDS
        }
        self.count = dict.fromkeys(KINDS, 0)
        self._pairing, self._heard = Pairing(_GAP_S), Heard(_RESET_S)
        self._errors = RunningErrors(_RESET_S, WINDOW_S)
        self._origin: int | None = None
        self._lock = threading.Lock()
        self.error: RunningError | None = None

    def voltage(self, stamp_ns: int, voltage: tuple[float, float]) -> None:
        """What is commanded [V] from a stamp [ns] on."""
        with self._lock:
            epoch = self._epoch["voltage"].of(stamp_ns)
            self._heard.state(epoch, stamp_ns, voltage)
            self._errors.state(epoch, stamp_ns, voltage)
            self._add("voltage", stamp_ns, *voltage)

    def measured(self, stamp_ns: int, sin_theta: float) -> None:
        """A measured angle; NaN in a frame without."""
        with self._lock:
            epoch = self._epoch["measured"].of(stamp_ns)
            self._heard.measured(epoch, stamp_ns, sin_theta)
            self._paired(self._pairing.measured(epoch, stamp_ns, sin_theta))
            self._add("measured", stamp_ns, sin_theta)

    def simulated(self, stamp_ns: int, sin_theta: float) -> None:
        """A simulated angle."""
        with self._lock:
            epoch = self._epoch["simulated"].of(stamp_ns)
            self._paired(self._pairing.simulated(epoch, stamp_ns, sin_theta))
            self._add("simulated", stamp_ns, sin_theta)

    def since(self, seen: dict[str, int]) -> dict[str, np.ndarray]:
        """The samples that came after the first `seen` ones, by kind: [n, 3] of time [s], value, second value."""
        with self._lock:
            return {kind: self._after(kind, seen.get(kind, 0)) for kind in KINDS}

    def recordings(self, folder: Path, ended: bool = False) -> list[Recording]:
        """The runs heard so far, each written to a file of its own. Raises SysidError where there is none.

        ended: without one that is going on.
        """
        with self._lock:
            found = self._heard.recordings(ended)
        folder.mkdir(parents=True, exist_ok=True)
        out = []
        for recording in found:
            path = folder / f"{recording.name}.mcap"
            if not path.exists():
                write_recording(recording, path)
            out.append(replace(recording, path=path))
        return out

    def _add(self, kind: str, stamp_ns: int, value: float, second: float = 0.0) -> None:
        self._origin = self._origin if self._origin is not None else stamp_ns
        self._samples[kind].append(((stamp_ns - self._origin) * 1e-9, value, second))
        self.count[kind] += 1

    def _after(self, kind: str, seen: int) -> np.ndarray:
        samples = self._samples[kind]
        new = min(self.count[kind] - seen, len(samples)) if seen <= self.count[kind] else len(samples)
        rows = [samples[index] for index in range(len(samples) - new, len(samples))]
        return np.array(rows, dtype=np.float32).reshape(-1, 3)

    def _paired(self, pairs: Iterable[Pair]) -> None:
        for pair in pairs:
            self.error = self._errors.add(pair)
