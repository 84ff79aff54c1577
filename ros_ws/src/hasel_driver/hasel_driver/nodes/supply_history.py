# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a supply went through, kept on disk: faults, breakdowns, and how the muscles' leakage grows.

One JSON object a line, appended and never rewritten:
`{"time": "2026-01-31T12:00:00+00:00", "event": "fault", "code": 2, "name": "OVERCURRENT", "text": …, …}`
`{"time": …, "event": "leakage", "channel": "upper", "voltage_v": 5000.0, "current_a": 5.2e-06, "reports": 5950,
"spread_a": 4e-07, "resistance_ohm": 9.6e8}`

The board's monitor counts in steps of 1 µA. The mean of a minute's reports is finer by as much as they scatter over
those steps, which `spread_a`, their standard deviation, tells: where it is 0, the current is known to 1 µA only.
"""

import json
import queue
import statistics
import threading
from collections.abc import Callable
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from hasel_driver.protocol.faults import Fault, FaultCode
from hasel_driver.protocol.limits import MUSCLE_NAMES
from hasel_driver.protocol.status import Mode, SupplyStatus

BREAKDOWNS = {FaultCode.OVERCURRENT}
SETTLED_S = 0.5  # at one voltage, after which what still flows is leakage
LEAST_LEAKAGE_V = 1000.0
LEAKAGE_PERIOD_S = 60.0  # between two notes of one channel


class SupplyHistory:
    """`take` costs the caller nothing but a look: a thread of its own writes. An empty path keeps no history."""

    def __init__(self, path: str, warn: Callable[[str], object]) -> None:
        self._path = Path(path).expanduser() if path else None
        self._warn = warn
        self._fault: Fault | None = None
        self._steady_since_s: list[float | None] = [None, None]
        self._steady_v = [0.0, 0.0]
        self._noted_s = [float("-inf")] * 2
        self._currents: list[list[float]] = [[], []]
        self.faults = self.breakdowns = 0
        self.leakage_a: list[float | None] = [None, None]
        self._count_the_past()
        self._entries: queue.SimpleQueue[dict[str, Any] | None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._write, name="history", daemon=True)
        self._thread.start()

    def take(self, status: SupplyStatus) -> None:
        """Look at a status; note a new fault, and leakage at a voltage that has long stood still."""
        if status.fault is not None and status.fault != self._fault:
            self._note_fault(status.fault, status)
        self._fault = status.fault
        for channel in range(2):
            self._watch_leakage(channel, status)

    def summary(self) -> dict[str, object]:
        """Counts since the file began, and the last leakage [A]."""
        leakage = {
            f"leakage_{name}_a": "unknown" if value is None else f"{value:.2e}"
            for name, value in zip(MUSCLE_NAMES, self.leakage_a, strict=True)
        }
        return {"faults_ever": self.faults, "breakdowns_ever": self.breakdowns, **leakage}

    def close(self) -> None:
        """Write what is left."""
        self._entries.put(None)
        self._thread.join(timeout=2.0)

    def _note_fault(self, fault: Fault, status: SupplyStatus) -> None:
        self.faults += 1
        self.breakdowns += fault.code in BREAKDOWNS
        self._note(
            event="fault",
            code=int(fault.code),
            name=fault.code.name,
            text=str(fault),
            output=status.output,
            measured_v=_finite(status.measured_v),
            current_a=_finite(status.current_a),
        )

    def _watch_leakage(self, channel: int, status: SupplyStatus) -> None:
        voltage_v, current_a = status.commanded_v[channel], status.current_a[channel]
        live = status.mode is Mode.ACTIVE and abs(voltage_v) >= LEAST_LEAKAGE_V and current_a == current_a
        if not live or voltage_v != self._steady_v[channel]:
            self._steady_v[channel] = voltage_v
            self._steady_since_s[channel] = status.time_s if live else None
            self._currents[channel].clear()
            return
        begun_s = self._steady_since_s[channel]
        if begun_s is None or status.time_s - begun_s < SETTLED_S:
            return
        self._currents[channel].append(current_a)
        due = status.time_s - self._noted_s[channel] >= LEAKAGE_PERIOD_S
        if due and status.time_s - begun_s >= 2 * SETTLED_S:
            self._noted_s[channel] = status.time_s
            currents_a, self._currents[channel] = self._currents[channel], []
            mean_a = self.leakage_a[channel] = statistics.fmean(currents_a)
            self._note(
                event="leakage",
                channel=MUSCLE_NAMES[channel],
                voltage_v=voltage_v,
                current_a=mean_a,
                reports=len(currents_a),
                spread_a=statistics.pstdev(currents_a),
                resistance_ohm=abs(voltage_v) / mean_a if mean_a > 0 else None,
            )

    def _note(self, **entry: object) -> None:
        now = datetime.now(timezone.utc).isoformat(timespec="milliseconds")
        self._entries.put({"time": now, **entry})

    def _write(self) -> None:
        while (entry := self._entries.get()) is not None:
            if self._path is None:
                continue
            try:
                self._path.parent.mkdir(parents=True, exist_ok=True)
                with self._path.open("a") as file:
                    file.write(json.dumps(entry) + "\n")
            except OSError as error:
                self._warn(f"The history {self._path} cannot be written ({error.strerror}): {entry}")

    def _count_the_past(self) -> None:
        if self._path is None or not self._path.is_file():
            return
        for line in self._path.read_text(errors="replace").splitlines():
            try:
                entry = json.loads(line)
                self.faults += entry["event"] == "fault"
                self.breakdowns += entry.get("code") in BREAKDOWNS
            except (ValueError, KeyError, TypeError, AttributeError):
                continue  # cut off by a power failure


def _finite(values: tuple[float, float]) -> list[float | None]:
    return [value if value == value else None for value in values]
