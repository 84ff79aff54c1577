"""The command lines: track, render, calibrate, bench."""
