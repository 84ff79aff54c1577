"""What the tracker must know about markers and regions; the defaults suit 4 mm blue dots at 6 px per mm."""

from dataclasses import dataclass, field

import numpy as np

from hasel_tracker.choices import BODY_KINDS
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.colour_gate import ColourRange
from hasel_tracker.tracking.head_side import SIDES, head_word

FEWEST_MARKERS, MOST_MARKERS = 2, 15
HEAD_SHARE, MIDDLE_SHARE = 5 / 190, 94 / 190  # where the swimmer's markers are, of its length with the fin


@dataclass(frozen=True)
class TrackerSettings:
    """Settings of the markers' search.

    marker_count: how many, 2 to 15. marker_radius_px: expected radius; 0 learns it from the first frame. region_px:
    how far a marker may be from where it is predicted. edge_px: half width of the band in which a marker's edge lies
    (more for blurred pictures). head: the side of the picture on which the head starts, or a point 'X,Y' near it;
    `auto` takes the thicker half of the body for the front. minimum_quality: below it a marker counts as lost.
    rest_direction_deg: of two markers alone, where the straight body points, anticlockwise from right. spacing: the
    distances from marker to marker, head first, in any unit, such as '89,96'; empty for even ones.

    Of the method midline: `body` is light or dark against the ground, or auto; `points` says at which shares of the
    length from the head, such as '0.05,0.5,1', the points are; empty puts marker_count of them where markers would be.
    """

    colour: ColourRange = field(default_factory=ColourRange)
    marker_count: int = 3
    marker_radius_px: float = 0.0
    smallest_radius_px: float = 4.0
    largest_radius_px: float = 60.0
    region_px: int = 16
    edge_px: int = 3
    head: str = "auto"
    minimum_quality: float = 0.5
    rest_direction_deg: float = 0.0
    spacing: str = ""
    body: str = "auto"
    points: str = ""

    def __post_init__(self) -> None:
        if self.marker_count not in range(FEWEST_MARKERS, MOST_MARKERS + 1):
            raise TrackerError(
                f"The number of markers is {self.marker_count}; expected {FEWEST_MARKERS} to {MOST_MARKERS}."
            )
        try:
            head_word(self.head)
        except (ValueError, AttributeError):
            raise TrackerError(
                f"The head is said to be at '{self.head}'; expected auto, {', '.join(SIDES)} or a point X,Y."
            ) from None
        if self.body not in BODY_KINDS:
            raise TrackerError(
                f"The body is said to be '{self.body}'; expected one of {', '.join(BODY_KINDS)}."
            )
        try:
            shares = np.array(
                [float(share) for share in self.points.split(",")] if self.points else [0.0, 1.0]
            )
        except ValueError:
            shares = np.array([np.nan])
        if not (shares[0] >= 0.0 and shares[-1] <= 1.0 and (np.diff(shares) > 0.0).all()):
            raise TrackerError(
                f"The points on the centre line are at '{self.points}'; expected rising shares of the length from 0 "
                "(head) to 1 (tail), such as 0.05,0.5,1."
            )
        if self.points and len(shares) != self.marker_count:
            raise TrackerError(
                f"Found {len(shares)} shares of the length for {self.marker_count} points; give as many as "
                "marker_count says."
            )
        try:
            distances = self.distances
        except (ValueError, AttributeError):
            distances = (float("nan"),)
        if len(distances) != self.marker_count - 1 or not all(each > 0.0 for each in distances):
            raise TrackerError(
                f"The spacing of {self.marker_count} markers is '{self.spacing}'; expected {self.marker_count - 1} "
                "positive distances from marker to marker, head first, such as 89,96; empty where they are even."
            )
        if not 0.0 < self.smallest_radius_px < self.largest_radius_px:
            raise TrackerError(
                f"The smallest marker radius is {self.smallest_radius_px} px and the largest "
                f"{self.largest_radius_px} px; expected 0 < smallest < largest."
            )
        if self.edge_px < 2 or self.region_px < 2:
            raise TrackerError(
                f"edge_px is {self.edge_px} and region_px {self.region_px}; expected at least 2 px each."
            )

    @property
    def distances(self) -> tuple[float, ...]:
        """Distances from marker to marker, head first, in any unit."""
        if not self.spacing:
            return (1.0,) * (self.marker_count - 1)
        return tuple(float(each) for each in self.spacing.split(","))

    @property
    def shares(self) -> tuple[float, ...]:
        """Shares of the length, from the head, of the method midline's points."""
        if self.points:
            return tuple(float(share) for share in self.points.split(","))
        if self.marker_count == 3:
            return HEAD_SHARE, MIDDLE_SHARE, 1.0
        return tuple(np.linspace(HEAD_SHARE, 1.0, self.marker_count).tolist())
