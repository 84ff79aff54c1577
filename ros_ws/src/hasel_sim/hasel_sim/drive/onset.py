"""The instants at which a drive begins, or ceases, to contract a muscle: what it aims at has a corner there."""

from typing import NamedTuple

import numpy as np

from hasel_sim.drive.schedule import DriveSchedule

_SHARP = 1e-6
_SOON_S = 8e-3 * 0.5 ** np.arange(20)


class Crossings(NamedTuple):
    """Where a magnitude passes the onset of its channel, between two times; [crossings] each.

    cell: number of the earlier of the two times; share: of the way between them, the magnitude taken to change
    steadily; off: by how much it misses the onset at the nearer of the two, over the onset.
    """

    cell: np.ndarray
    channel: np.ndarray
    share: np.ndarray
    off: np.ndarray


def crossings(time: np.ndarray, signal: np.ndarray, onsets: np.ndarray) -> Crossings:
    """Of a signal [n, channels] at its times [s] [n], in their order; onsets: [channels], 0 where there is none.

    Equal times mark a jump, which crosses in no time.
    """
    magnitude = np.abs(signal)
    above = magnitude > onsets
    passes = (above[1:] != above[:-1]) & (np.diff(time) > 0.0)[:, None] & (onsets > 0.0)
    cell, channel = np.nonzero(passes)
    onset = onsets[channel]
    before, after = magnitude[cell, channel] - onset, magnitude[cell + 1, channel] - onset
    share = before / (before - after)
    off = np.minimum(np.abs(before), np.abs(after)) / onset
    order = np.lexsort((share, cell))
    return Crossings(cell[order], channel[order], share[order], off[order])


def soon_after_switches(schedule: DriveSchedule, onsets: np.ndarray) -> np.ndarray:
    """Times [s] after the switches past an onset [channels], for whatever follows them, however fast.

    By halves from 8 ms, twice the usual step of a simulation, down to the difference step of a lag's derivative.
    """
    above = np.vstack([np.zeros(len(onsets), dtype=bool), np.abs(schedule.signal) > onsets])
    passes = np.any(above[1:] != above[:-1], axis=1)
    return (schedule.time[passes][:, None] + _SOON_S).ravel()


def secants(found: Crossings, origin: np.ndarray) -> np.ndarray:
    """Times [s] nearer to the crossings that lie between two times of `origin` [n] and near to neither."""
    blurred = found.off > _SHARP
    cell = found.cell[blurred]
    return origin[cell] + found.share[blurred] * (origin[cell + 1] - origin[cell])


def with_onsets(
    time: np.ndarray, signal: np.ndarray, onsets: np.ndarray, found: Crossings
) -> tuple[np.ndarray, np.ndarray]:
    """The signal [n, channels] at its times [s] [n] and, besides, at its onsets [channels] where it crosses them."""
    cell, channel, share, _ = found
    rows = signal[cell] + share[:, None] * (signal[cell + 1] - signal[cell])
    sign = np.where(signal[cell, channel] + signal[cell + 1, channel] < 0.0, -1.0, 1.0)
    rows[np.arange(len(cell)), channel] = sign * onsets[channel]
    new = time[cell] + share * (time[cell + 1] - time[cell])
    return np.insert(time, cell + 1, new), np.insert(signal, cell + 1, rows, axis=0)
