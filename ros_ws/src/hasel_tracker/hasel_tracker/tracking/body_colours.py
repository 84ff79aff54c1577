# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The colours of a body and of what lies beside it, in a view straightened from one dot to the next."""

from dataclasses import dataclass

import numpy as np

LEAST_SPREAD = 3.0
OUTLIER_SHARE = 0.1
OUTLIER_DENSITY = np.log(OUTLIER_SHARE) - 3 * np.log(256.0)


@dataclass(frozen=True)
class StraightView:
    """What lies between two dots: picture points `first` + station_px · along + offset · across [px].

    colours (stations, offsets, 3), the offsets `step_px` apart about zero; path_px: (stations,) offsets of the line
    that looks most like a body; models: mean colour of the body and its spread, colours of what is beside (stations, 3)
    and their spread.
    """

    first: np.ndarray
    along: np.ndarray
    across: np.ndarray
    length_px: float
    station_px: np.ndarray
    step_px: float
    colours: np.ndarray
    path_px: np.ndarray
    models: tuple[np.ndarray, ...]

    @property
    def last(self) -> np.ndarray:
        """The dot at the other end (2,) [px]."""
        return self.first + self.length_px * self.along


def log_densities(colours: np.ndarray, models: tuple[np.ndarray, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Log densities of every colour (1, stations · offsets) as the body's and as that of what is beside."""
    trend, inner_spread, beside, outer_spread = models
    inner = log_density((colours - trend).reshape(1, -1, 3), inner_spread[None])
    return inner, log_density((colours - beside[:, None]).reshape(1, -1, 3), outer_spread[None])


def covariance(rest: np.ndarray) -> np.ndarray:
    """Covariance (paths, 3, 3) of most of the colours (paths, samples, 3), with a floor for noise and coding."""
    size = np.abs(rest).sum(axis=2)
    share = int(0.8 * size.shape[1])
    kept = size <= np.partition(size, share, axis=1)[:, share, None]
    weighted = rest * (kept / kept.sum(axis=1, keepdims=True)).astype(np.float32)[..., None]
    spread = weighted.transpose(0, 2, 1) @ rest
    return 1.6 * spread + np.float32(LEAST_SPREAD**2) * np.eye(3, dtype=np.float32)


def log_density(rest: np.ndarray, spread: np.ndarray) -> np.ndarray:
    """Log density of colours (paths, samples, 3) about zero, with a share of outliers."""
    distance = ((rest @ np.linalg.inv(spread)) * rest).sum(axis=2)
    usual = -0.5 * (distance + np.linalg.slogdet(spread)[1][:, None] + 3.0 * np.log(2.0 * np.pi))
    return np.logaddexp(usual, OUTLIER_DENSITY)
