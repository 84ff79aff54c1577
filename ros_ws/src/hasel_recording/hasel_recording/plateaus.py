# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Levels at which a measured drive stands: a column that ripples about them, such as a supply's monitor.

A drive that goes through a continuum, such as a pressure sensor's, is none of these and stays as it was measured.
"""

from dataclasses import dataclass

import numpy as np

from hasel_recording.drive_channel import DriveChannel

APART = 8.0
"""Plateaus are this many times their ripple apart; the halves of a sine or of a ramp are 3 to 4 times theirs."""
GAP = 6.0
"""No rows lie farther apart than this many times the ripple within one plateau."""
FINEST = 0.005
"""Share of the largest level within which values that ripple are one level: an amplitude alike to a hundredth."""
STANDING = 0.9
"""Share of the rows that stand on plateaus; the others are on their way between two of them."""
WHITE = 0.5
"""Ripple from row to row, as a share of what white noise of its size has, below which it is a movement."""
_QUIET = 0.6
_NORMAL = 1.19  # 60 % of the differences of unit white noise are below this
_MAD = 0.6745


@dataclass(frozen=True)
class Plateaus:
    """levels [k]: ascending, in the channel's unit; ripple: rms about them; standing [n]: the level at each row."""

    levels: np.ndarray
    ripple: float
    standing: np.ndarray


def find_plateaus(values: np.ndarray, scale: float) -> Plateaus | None:
    """The plateaus of a channel [n]; None where its values are exact already or go through a continuum.

    scale: the largest magnitude of all channels of its quantity.
    """
    steps = np.abs(np.diff(values))
    changes = np.count_nonzero(steps)
    if not np.any(np.diff(np.unique(values)) < FINEST * scale):
        return None
    noise = float(np.quantile(steps, _QUIET)) / _NORMAL
    in_order = np.sort(values)
    splits = np.flatnonzero(np.diff(in_order) > max(GAP * noise, FINEST * scale))
    groups = [group for group in np.split(in_order, splits + 1) if len(group) > 1]
    groups = [group for group in groups if _stands(values, group)]
    if not groups or sum(map(len, groups)) < STANDING * len(values):
        return None
    levels = np.array([_level(group, scale) for group in groups])
    spread = max(float(np.std(group)) for group in groups)
    if len(levels) > 1 and np.diff(levels).min() < APART * spread:
        return None
    if len(levels) == 1 and spread > np.abs(levels).max(initial=scale) / APART:
        return None
    standing = levels[np.abs(values[:, None] - levels).argmin(axis=1)]
    if changes <= 1.5 * np.count_nonzero(np.diff(standing)) or not _ripples(values, standing):
        return None
    return Plateaus(np.unique(levels), float(np.median(np.abs(values - standing))) / _MAD, standing)


def acting(channels: tuple[DriveChannel, ...], values: np.ndarray) -> tuple[np.ndarray, tuple[str, ...]]:
    """What acts, [n, channels]: the plateau where a channel stands on plateaus, else what was measured.

    With one sentence for each channel whose ripple was taken off.
    """
    if len(values) < 4 or not np.isfinite(values).all():
        return values, ()
    acts, said = values, []
    for number, channel in enumerate(channels):
        alike = [other.quantity == channel.quantity for other in channels]
        found = find_plateaus(values[:, number], float(np.abs(values[:, alike]).max()))
        if found is not None:
            acts = np.array(acts)
            acts[:, number] = found.standing
            levels = ", ".join(f"{level:.6g}" for level in found.levels)
            said.append(
                f"{channel} ripples by {channel.shown(float(f'{found.ripple:.2g}'))} rms about {levels} "
                f"{channel.unit}, which are taken for what acts"
            )
    return acts, tuple(said)


def _stands(values: np.ndarray, group: np.ndarray) -> bool:
    """Whether rows of this group follow one another somewhere: a value met on the way does not."""
    inside = (values >= group[0]) & (values <= group[-1])
    return bool(np.any(inside[1:] & inside[:-1]))


def _level(group: np.ndarray, scale: float) -> float:
    """The roundest number within the uncertainty of the group's median; 0 where it rests."""
    middle = float(np.median(group))
    if abs(middle) < FINEST * scale:
        return 0.0
    uncertainty = 2.5 * float(np.std(group)) / np.sqrt(len(group)) + 1e-9 * scale
    return roundest(middle - uncertainty, middle + uncertainty)


def roundest(low: float, high: float) -> float:
    """The number between two with the fewest digits."""
    middle = 0.5 * (low + high)
    for digits in range(1, 16):
        number = float(f"{middle:.{digits - 1}e}")
        if low <= number <= high:
            return number
    return middle


def _ripples(values: np.ndarray, standing: np.ndarray) -> bool:
    """Whether what is off the plateaus goes up and down from row to row, as noise does and a movement does not."""
    off, stays = values - standing, np.diff(standing) == 0
    size = float(np.median(np.abs(off))) / _MAD
    between = float(np.median(np.abs(np.diff(off)[stays]))) / _MAD / np.sqrt(2.0)
    return size == 0 or between >= WHITE * size
