# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The node's parameters: those of the search can change while it runs."""

from hasel_common.node_parameter import AUTOSTART, NodeParameter

from hasel_tracker.tracking import BODY_KINDS, DEFAULT_METHOD, METHODS
from hasel_tracker.tracking.tracker_settings import COLOUR_KEYS, SEARCH_KEYS, TrackerSettings, flat

DEFAULTS = flat(TrackerSettings())


def _search(
    name: str,
    description: str,
    unit: str = "",
    low: float | None = None,
    high: float | None = None,
    choices: tuple[str, ...] = (),
) -> NodeParameter:
    return NodeParameter(name, DEFAULTS[name], description, unit, low, high, choices, changeable=True)


PARAMETERS = (
    NodeParameter(*AUTOSTART),
    NodeParameter("source", "0", "camera number or device, video file, folder of images, or topic:NAME"),
    NodeParameter("width", 1920, "asked of the camera", "px", 16, 8192),
    NodeParameter("height", 1080, "asked of the camera", "px", 16, 8192),
    NodeParameter("frame_rate", 120.0, "asked of the camera; of a folder of images", "1/s", 1.0, 1000.0),
    NodeParameter("pixel_format", "MJPG", "asked of the camera, four characters"),
    NodeParameter(
        "exposure", -1.0, "in the camera driver's units; -1 leaves it to the camera", "", -1.0, 1e6
    ),
    NodeParameter("queue_size", 8, "frames that may wait; the oldest is dropped when full", "", 1, 1000),
    NodeParameter("decode_threads", 2, "threads that decode JPEG", "", 1, 16),
    NodeParameter("method", DEFAULT_METHOD, "how markers are located", choices=METHODS),
    NodeParameter("calibration", "", "file from `calibrate board`; empty for none"),
    NodeParameter("roi", "", "look only within X,Y,WIDTH,HEIGHT of the picture; empty for all of it", "px"),
    NodeParameter(
        "at", "", "the markers in the first frame, X,Y X,Y …, head first; empty to find them", "px"
    ),
    NodeParameter("mirrored", False, "the camera looks from below or over a mirror"),
    NodeParameter("frame_id", "camera", "of the stamped messages, within the node's namespace"),
    NodeParameter("preview_rate", 5.0, "of the annotated picture; 0 for none", "1/s", 0.0, 30.0),
    NodeParameter("preview_width", 640, "of the annotated picture", "px", 64, 1920),
    NodeParameter("video_folder", ".", "where `record_video` writes"),
    _search("hue_low", "marker colour: lowest hue, in half degrees; above hue_high it wraps", "", 0, 179),
    _search("hue_high", "marker colour: highest hue, in half degrees", "", 0, 179),
    _search("saturation_low", "marker colour: lowest saturation", "", 0, 255),
    _search("value_low", "marker colour: lowest value", "", 0, 255),
    _search("marker_radius_px", "expected radius; 0 learns it at the start", "px", 0.0, 500.0),
    _search("smallest_radius_px", "smaller blobs are no markers", "px", 1.0, 500.0),
    _search("largest_radius_px", "larger blobs are no markers", "px", 2.0, 1000.0),
    _search("region_px", "how far a marker may be from its prediction", "px", 2, 500),
    _search("edge_px", "half width of the band of a marker's edge; more if blurred", "px", 2, 50),
    _search("head", "auto, the side of the picture on which the head starts, or a point X,Y near it"),
    _search("marker_count", "how many markers, in order along the body", "", 2, 15),
    _search(
        "rest_direction_deg",
        "of two markers: where the straight body points, anticlockwise from right",
        "°",
        -180.0,
        180.0,
    ),
    _search(
        "spacing",
        "distances from marker to marker, head first, in any unit, such as 89,96; empty for even ones",
    ),
    _search("body", "of midline: light or dark against the ground, or auto", choices=BODY_KINDS),
    _search(
        "points",
        "of midline: shares of the length from head to tail, such as 0.05,0.5,1; empty for the markers'",
    ),
    _search("minimum_quality", "below it a marker counts as lost", "", 0.0, 1.0),
)
SEARCH_NAMES = COLOUR_KEYS + SEARCH_KEYS
