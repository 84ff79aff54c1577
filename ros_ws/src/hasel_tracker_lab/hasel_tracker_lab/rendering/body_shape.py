"""What the drawn swimmer looks like: outline, spine, markers and colours (lengths in m, colours as BGR)."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class BodyShape:
    """The default swimmer's proportions; stations are distances from the nose along the centre line."""

    body_length_m: float = 0.160
    fin_length_m: float = 0.030
    spine_thickness_m: float = 0.001
    half_height_scale_m: float = 0.0075
    half_height_coefficients: tuple[float, ...] = (
        0.3,
        5.13847447,
        -13.84583811,
        19.51736782,
        -18.6011192,
        7.61111502,
    )
    muscle_stations_m: tuple[float, float] = (0.052, 0.152)
    marker_stations_m: tuple[float, float, float] = (0.005, 0.094, 0.190)
    marker_radius_m: float = 0.002
    body_colour: tuple[int, int, int] = (214, 222, 226)
    spine_colour: tuple[int, int, int] = (120, 128, 132)
    marker_colour: tuple[int, int, int] = (168, 72, 22)

    @property
    def total_length_m(self) -> float:
        """Length from the nose to the tip of the fin [m]."""
        return self.body_length_m + self.fin_length_m

    def half_height(self, stations_m: np.ndarray) -> np.ndarray:
        """Half height of the soft body [m] at the stations, zero behind the body."""
        relative = np.asarray(stations_m) / self.body_length_m
        height = self.half_height_scale_m * np.polynomial.polynomial.polyval(
            relative, self.half_height_coefficients
        )
        return np.where(relative <= 1.0, height, 0.0)
