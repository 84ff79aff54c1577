# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults of the set-up, found before any physical effect is accused."""

from hasel_sysid.data_quality.against_model import check_against_model
from hasel_sysid.data_quality.finding import DataFinding, Severity
from hasel_sysid.data_quality.recording_check import check_recording, refusal

__all__ = ["DataFinding", "Severity", "check_against_model", "check_recording", "refusal"]
