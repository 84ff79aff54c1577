# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Crash-safe recordings of experiments: MCAP and CSV."""

from hasel_common.provenance import lazy_version

from hasel_recording.drive_channel import HASEL_PAIR, DriveChannel, parse_column
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.mcap_recorder import McapRecorder
from hasel_recording.reading import read_recording, read_recordings, write_recording
from hasel_recording.recording import Recording, sin_theta_from_markers

__all__ = [
    "HASEL_PAIR",
    "DriveChannel",
    "McapRecorder",
    "Recording",
    "RecordingError",
    "RecordingWarning",
    "parse_column",
    "read_recording",
    "read_recordings",
    "sin_theta_from_markers",
    "write_recording",
]

__getattr__ = lazy_version(__name__)
