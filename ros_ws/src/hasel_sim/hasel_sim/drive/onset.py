"""The instants at which a drive begins, or ceases, to contract a muscle."""

import numpy as np


def with_onsets(time: np.ndarray, signal: np.ndarray, onsets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A signal [n, channels] at its times [s] [n] and, besides, where its magnitude crosses the onsets [channels].

    What it aims at has a corner there: without it, a ramp that begins between two times begins at one of them. The
    magnitude is taken to change steadily between its times; equal times mark a jump, which crosses in no time.
    """
    magnitude = np.abs(signal)
    above = magnitude > onsets
    crosses = (above[1:] != above[:-1]) & (np.diff(time) > 0.0)[:, None] & (onsets > 0.0)
    cell, channel = np.nonzero(crosses)
    before, after = magnitude[cell, channel], magnitude[cell + 1, channel]
    share = (onsets[channel] - before) / (after - before)
    rows = signal[cell] + share[:, None] * (signal[cell + 1] - signal[cell])
    sign = np.where(signal[cell, channel] + signal[cell + 1, channel] < 0.0, -1.0, 1.0)
    rows[np.arange(len(cell)), channel] = sign * onsets[channel]
    new = time[cell] + share * (time[cell + 1] - time[cell])
    order = np.lexsort((share, cell))
    place = cell[order] + 1
    return np.insert(time, place, new[order]), np.insert(signal, place, rows[order], axis=0)
