"""What the tracker must know about markers and regions; the defaults suit 4 mm blue dots at 6 px per mm."""

from dataclasses import dataclass, field

from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.colour_gate import ColourRange
from hasel_tracker.tracking.head_side import SIDES, head_word

METHODS = ("contour", "moment", "apriltag", "csrt")
FEWEST_MARKERS, MOST_MARKERS = 2, 15


@dataclass(frozen=True)
class TrackerSettings:
    """Settings of the markers' search.

    marker_count: how many, 2 to 15. marker_radius_px: expected radius; 0 learns it from the first frame. region_px:
    how far a marker may be from where it is predicted. edge_px: half width of the band in which a marker's edge lies
    (more for blurred pictures). head: the side of the picture on which the head starts, or a point 'X,Y' near it;
    `auto` takes the thicker half of the body for the front. minimum_quality: below it a marker counts as lost.
    rest_direction_deg: of two markers alone, where the straight body points, anticlockwise from right.
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

    def __post_init__(self) -> None:
        try:
            head_word(self.head)
        except (ValueError, AttributeError):
            raise TrackerError(
                f"The head is said to be at '{self.head}'; expected auto, {', '.join(SIDES)} or a point X,Y."
            ) from None
        if not FEWEST_MARKERS <= self.marker_count <= MOST_MARKERS:
            raise TrackerError(
                f"The number of markers is {self.marker_count}; expected {FEWEST_MARKERS} to {MOST_MARKERS}."
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
