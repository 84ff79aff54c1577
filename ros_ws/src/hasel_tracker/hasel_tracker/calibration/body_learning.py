"""Learn from one picture how a swimmer without dots stands out from the ground, and show it."""

from dataclasses import dataclass, replace

import cv2
import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.centre_line import CentreLine, centre_line
from hasel_tracker.tracking.silhouette import Silhouette, find_silhouette
from hasel_tracker.tracking.tracker_settings import TrackerSettings

SELECTED, LINE = (255, 0, 255), (60, 220, 60)


@dataclass(frozen=True)
class LearnedBody:
    """The settings, the silhouette found with them, and its centre line."""

    settings: TrackerSettings
    silhouette: Silhouette
    line: CentreLine

    def __str__(self) -> str:
        return (
            f"A {self.settings.body} body of {self.line.length_px:.0f} px by "
            f"{2 * self.line.half_width_px.max():.0f} px, {2 * self.silhouette.threshold:.0f} grey levels from the "
            "ground."
        )


def learn_body(image: np.ndarray, body: str = "auto") -> LearnedBody:
    """Find the one slender body in an 8-bit BGR image; raises TrackerError with the reason where there is none."""
    search = find_silhouette(image, body)
    if search.silhouette is None:
        raise TrackerError(f"No swimmer was found: {search.note}.")
    line = centre_line(search.silhouette)
    if line is None:
        raise TrackerError(
            "No swimmer was found: what stands out from the ground is no slender body; leave it out with --roi."
        )
    settings = replace(TrackerSettings(), body="light" if search.silhouette.light else "dark")
    return LearnedBody(settings, search.silhouette, line)


def body_picture(image: np.ndarray, learned: LearnedBody) -> np.ndarray:
    """The image greyed, with the silhouette's outline in magenta and the centre line in green; 8-bit BGR."""
    grey = cv2.cvtColor(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), cv2.COLOR_GRAY2BGR)
    corner = tuple(int(value) for value in learned.silhouette.corner)
    outline = cv2.findContours(
        learned.silhouette.mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE, offset=corner
    )[0]
    cv2.drawContours(grey, outline, -1, SELECTED, 1)
    points = np.rint(16 * learned.line.at(np.linspace(0.0, 1.0, 200))).astype(np.int32)
    cv2.polylines(grey, [points], False, LINE, 1, cv2.LINE_AA, 4)
    return grey
