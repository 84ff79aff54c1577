# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the tracker must know of markers and regions, as a ROS 2 parameter file too; the defaults suit 4 mm blue dots at
6 px per mm."""

from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from hasel_common.names import nearest

from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking import BODY_KINDS

HUE_CIRCLE = 180
BRIGHT_VALUE = 200.0
BRIGHT_PERCENTILE = 99.0
FEWEST_MARKERS, MOST_MARKERS = 2, 15
SIDES = ("left", "right", "top", "bottom")
HEAD_SHARE, MIDDLE_SHARE = 5 / 190, 94 / 190  # where the swimmer's markers are, of its length with the fin


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


def head_word(head: str) -> np.ndarray | str:
    """`auto`, a side, or the point (2,) that 'X,Y' names; raises ValueError for anything else."""
    if head == "auto" or head in SIDES:
        return head
    x, _, y = head.partition(",")
    return np.array([float(x), float(y)])


COLOUR_KEYS = tuple(each.name for each in fields(ColourRange))
SEARCH_KEYS = tuple(each.name for each in fields(TrackerSettings) if each.name != "colour")


def settings_from(values: dict[str, Any]) -> TrackerSettings:
    """Settings from flat names such as `hue_low` or `region_px`; what is not named keeps its default."""
    colour = {key: values[key] for key in COLOUR_KEYS if key in values}
    search = {key: values[key] for key in SEARCH_KEYS if key in values}
    try:
        return TrackerSettings(colour=ColourRange(**colour), **search)
    except TypeError as error:
        raise TrackerError(
            f"A tracker setting has a value of the wrong kind ({error}); give a number."
        ) from error


def flat(settings: TrackerSettings) -> dict[str, Any]:
    """Settings as flat names and values."""
    values = asdict(settings)
    return values.pop("colour") | values


def save_settings(settings: TrackerSettings, path: Path) -> None:
    """Write a parameter file for `ros2 run hasel_tracker tracker --ros-args --params-file`."""
    Path(path).write_text(yaml.safe_dump({"/**": {"ros__parameters": flat(settings)}}, sort_keys=False))


def load_settings(path: Path) -> TrackerSettings:
    """Read a parameter file; raises TrackerError for a file that is not one or a name that is not known."""
    try:
        content = yaml.safe_load(Path(path).read_text())
        values = next(iter(content.values()))["ros__parameters"]
    except (
        OSError,
        UnicodeDecodeError,
        yaml.YAMLError,
        AttributeError,
        KeyError,
        TypeError,
        StopIteration,
    ) as error:
        raise TrackerError(
            f"The settings {path} are not a ROS 2 parameter file; make one with `calibrate colour`."
        ) from error
    for key in values:
        if key not in COLOUR_KEYS + SEARCH_KEYS:
            near = nearest(key, COLOUR_KEYS + SEARCH_KEYS, similarity=0.0)
            raise TrackerError(
                f"The settings {path} have '{key}', which is not known; did you mean '{near}'?"
            )
    return settings_from(values)
