"""What a method says about one marker."""

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class MarkerMeasurement:
    """Centre (2,) [px], area [px²] and contrast to the background [grey levels] of a marker.

    noise: what is left unexplained, in the method's own terms. solidity: share of the marker that is seen whole, 0 to
    1. sigma_px: standard deviation of the centre, each way, that this explains. clarity: 1 for a clear marker, less
    for one in much noise.
    """

    centre: np.ndarray
    area: float
    contrast: float
    noise: float
    solidity: float
    sigma_px: float = float("nan")
    clarity: float = 1.0

    def moved_by(self, offset: np.ndarray) -> "MarkerMeasurement":
        """The same in pixels whose origin lies `offset` (2,) before."""
        return replace(self, centre=self.centre + offset)
