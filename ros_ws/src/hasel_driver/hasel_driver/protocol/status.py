# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The states of the supply, what is known of its ground contacts, and what is known about it now."""

import math
from dataclasses import dataclass
from enum import IntEnum

from hasel_driver.protocol.faults import Fault
from hasel_driver.protocol.limits import Voltages

UNKNOWN: Voltages = (math.nan, math.nan)
WORDS = {
    "grounded": "output grounded",
    "commanded": "output commanded to ground, not proven",
    "live": "output live",
    "unknown": "output unknown",
}


class Mode(IntEnum):
    """STANDBY and FAULT are grounded, ARMED is grounded at 0 V, ACTIVE drives the muscles."""

    STANDBY = 0
    ARMED = 1
    ACTIVE = 2
    FAULT = 3

    @property
    def may_be_live(self) -> bool:
        """Whether high voltage may be on the output in this mode."""
        return self in (Mode.ARMED, Mode.ACTIVE)


class Ground(IntEnum):
    """Read in the order of what it is worth; a person may come near in PROVEN only, with a ground stick."""

    NOT = 0  # live, or nothing is known
    COMMANDED = 1  # the contacts are commanded to ground, and less than 200 V measured: not proven
    PROVEN = 2  # besides, read back from auxiliary contacts, or by how fast a charged muscle was discharged


@dataclass(frozen=True)
class SupplyStatus:
    """What is known about the supply now; `commanded_v` and the rest are NaN where it is not known."""

    time_s: float
    mode: Mode
    fault: Fault | None
    ground: Ground | None  # None: not known
    commanded_v: Voltages
    measured_v: Voltages
    current_a: Voltages
    interlock_closed: tuple[bool, bool] | None = None
    silent_s: float = 0.0  # since the last report of a supply at rest, where that is too long ago
    note: str = ""  # why it disarmed itself, where that was no fault

    @property
    def output(self) -> str:
        """`grounded` only where it is proven; else `commanded` to ground, `live` or `unknown`."""
        if self.ground is None:
            return "unknown"
        return {Ground.PROVEN: "grounded", Ground.COMMANDED: "commanded", Ground.NOT: "live"}[self.ground]

    @property
    def quiet(self) -> bool | None:
        """Whether the ground contacts are commanded and little is measured, proven or not; None: not known."""
        return None if self.ground is None else self.ground is not Ground.NOT

    def __str__(self) -> str:
        why = f" ({self.fault or self.note})" if self.fault or self.note else ""
        return f"{self.mode.name}{why}, {WORDS[self.output]}"
