"""Learning which physical effect is missing from a fitted model."""

from hasel_sysid.diagnosis.result import Diagnosis, Finding, Verdict

__all__ = ["Diagnosis", "Finding", "Verdict"]
