"""Show what a learned colour range selects."""

import cv2
import numpy as np

from hasel_tracker.calibration.colour_learning import LearnedColour
from hasel_tracker.tracking.bending_tracker import TrackedFrame
from hasel_tracker.tracking.marker_set import MarkerSet, bending_angle
from hasel_tracker.video.annotation import annotate

SELECTED = (255, 0, 255)


def learned_picture(image: np.ndarray, learned: LearnedColour) -> np.ndarray:
    """The image greyed, pixels in the colour range in magenta, the markers found marked; 8-bit BGR."""
    grey = cv2.cvtColor(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), cv2.COLOR_GRAY2BGR)
    grey[learned.settings.colour.mask(image) > 0] = SELECTED
    markers = MarkerSet(learned.markers_px, np.ones(3))
    tracked = TrackedFrame(0.0, markers, *bending_angle(learned.markers_px))
    return annotate(grey, tracked, f"{100 * learned.stray_share:.2g} % elsewhere")
