# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A fault of the set-up, named as what it is."""

from dataclasses import dataclass
from enum import Enum
from typing import Any


class Severity(str, Enum):
    """error: results from this recording mislead; warning: look at it, results may still hold."""

    ERROR = "error"
    WARNING = "warning"


@dataclass(frozen=True)
class DataFinding:
    """fault: its name; evidence: what was found, with `number`; advice: what to do; recording: where."""

    fault: str
    severity: Severity
    evidence: str
    number: float
    advice: str
    recording: str = ""

    def __str__(self) -> str:
        where = f"{self.recording}: " if self.recording else ""
        return f"{where}{self.sentence}"

    @property
    def sentence(self) -> str:
        """The finding without its recording."""
        return f"{self.fault}: {self.evidence}; {self.advice}" + ("" if self.advice.endswith("?") else ".")

    def to_json(self) -> dict[str, Any]:
        """Plain words and numbers."""
        return {
            "fault": self.fault,
            "severity": self.severity.value,
            "evidence": self.evidence,
            "number": self.number,
            "advice": self.advice,
            "recording": self.recording,
        }


def error(fault: str, number: float, evidence: str, advice: str) -> DataFinding:
    """A fault with which results mislead."""
    return DataFinding(fault, Severity.ERROR, evidence, float(number), advice)


def warning(fault: str, number: float, evidence: str, advice: str) -> DataFinding:
    """A fault with which results may still hold."""
    return DataFinding(fault, Severity.WARNING, evidence, float(number), advice)
