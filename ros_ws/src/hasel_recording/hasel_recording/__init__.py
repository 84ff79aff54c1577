"""Crash-safe recordings of experiments: MCAP and CSV."""
