"""Faults of the set-up, found before any physical effect is accused."""

from hasel_sysid.data_gate.against_model import check_against_model
from hasel_sysid.data_gate.check import check_recording, refusal
from hasel_sysid.data_gate.finding import DataFinding, Severity

__all__ = ["DataFinding", "Severity", "check_against_model", "check_recording", "refusal"]
