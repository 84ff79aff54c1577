"""Crash-safe recordings of experiments: MCAP and CSV."""

from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.marker_angle import sin_theta_from_markers
from hasel_recording.mcap_recorder import McapRecorder
from hasel_recording.reading import read_recording, read_recordings, write_recording
from hasel_recording.recording import Recording

__all__ = [
    "McapRecorder",
    "Recording",
    "RecordingError",
    "RecordingWarning",
    "read_recording",
    "read_recordings",
    "sin_theta_from_markers",
    "write_recording",
]
