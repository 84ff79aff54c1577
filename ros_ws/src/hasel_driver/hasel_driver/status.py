"""What is known about the supply now."""

import math
from dataclasses import dataclass

from hasel_driver.faults import Fault
from hasel_driver.limits import Voltages
from hasel_driver.mode import Mode

UNKNOWN: Voltages = (math.nan, math.nan)


@dataclass(frozen=True)
class Status:
    """What is known about the supply now; `commanded_v` and the rest are NaN where it is not known."""

    time_s: float
    mode: Mode
    fault: Fault | None
    grounded: bool | None
    commanded_v: Voltages
    measured_v: Voltages
    current_a: Voltages
    interlock_closed: tuple[bool, bool] | None = None

    @property
    def output(self) -> str:
        """`grounded` only where the supply itself reports it, else `live` or `unknown`."""
        return {True: "grounded", False: "live", None: "unknown"}[self.grounded]

    def __str__(self) -> str:
        fault = f" ({self.fault})" if self.fault else ""
        return f"{self.mode.name}{fault}, output {self.output}"
