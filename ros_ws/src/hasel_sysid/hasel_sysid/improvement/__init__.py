"""Closing the loop: fit, diagnose, add, refit, until what is left is noise or nothing known explains it."""

from hasel_sysid.improvement.improve import improve
from hasel_sysid.improvement.result import Improvement, Stage, Status

__all__ = ["Improvement", "Stage", "Status", "improve"]
