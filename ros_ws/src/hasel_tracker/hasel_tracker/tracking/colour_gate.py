"""Which pixels may be a marker: a range of hue, saturation and value."""

from dataclasses import dataclass, replace

import numpy as np

from hasel_tracker.errors import TrackerError

HUE_CIRCLE = 180
BRIGHT_VALUE = 200.0
BRIGHT_PERCENTILE = 99.0


@dataclass(frozen=True)
class ColourRange:
    """A box in OpenCV's HSV space: hue 0–179 (half degrees, may wrap), saturation and value 0–255."""

    hue_low: int = 98
    hue_high: int = 130
    saturation_low: int = 90
    value_low: int = 35

    def __post_init__(self) -> None:
        for name, limit in (("hue_low", 179), ("hue_high", 179), ("saturation_low", 255), ("value_low", 255)):
            value = getattr(self, name)
            if not 0 <= value <= limit:
                raise TrackerError(
                    f"The colour range has {name} = {value}; expected 0 to {limit}. "
                    "Learn a range from a frame with `calibrate colour`."
                )

    def for_light_of(self, image: np.ndarray) -> "ColourRange":
        """The range with its lowest value lowered for an 8-bit BGR picture whose bright parts are dim."""
        bright = np.percentile(image[::8, ::8].max(axis=2), BRIGHT_PERCENTILE)
        return replace(self, value_low=round(self.value_low * min(bright / BRIGHT_VALUE, 1.0)))

    def mask(self, image: np.ndarray) -> np.ndarray:
        """Pixels of an 8-bit BGR image inside the range: 255, else 0; shape (height, width)."""
        import cv2  # not needed before there is a picture: --help of the node shows the defaults without it

        hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
        if self.hue_low <= self.hue_high:
            return self._between(hsv, self.hue_low, self.hue_high)
        return self._between(hsv, self.hue_low, HUE_CIRCLE - 1) | self._between(hsv, 0, self.hue_high)

    def _between(self, hsv: np.ndarray, low: int, high: int) -> np.ndarray:
        import cv2

        return cv2.inRange(hsv, (low, self.saturation_low, self.value_low), (high, 255, 255))
