"""Fewer points that look the same."""

import numpy as np


def decimate(time: np.ndarray, series: np.ndarray, most: int = 600) -> tuple[np.ndarray, np.ndarray]:
    """At most `most` points of a series [n] at times [s] [n]: first, last, and the extremes of stretches between."""
    if len(time) <= most:
        return time, series
    edges = np.linspace(0, len(time), max(1, (most - 2) // 2) + 1).astype(int)
    kept = {0, len(time) - 1}
    for begin, end in zip(edges[:-1], edges[1:], strict=True):
        part = series[begin:end]
        if np.isfinite(part).any():
            kept |= {begin + int(np.nanargmin(part)), begin + int(np.nanargmax(part))}
    index = np.array(sorted(kept))
    return time[index], series[index]
