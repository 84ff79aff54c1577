"""The command lines: track, calibrate."""
