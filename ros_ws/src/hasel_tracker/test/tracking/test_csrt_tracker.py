# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.tracking.csrt_tracker import CsrtTracker


def boxes_around(points: np.ndarray) -> list[tuple[int, int, int, int]]:
    """Boxes of 16 px about points."""
    return [(round(x) - 8, round(y) - 8, 16, 16) for x, y in points]


@pytest.mark.parametrize("given_boxes", [True, False])
def test_follows_within_pixels(frames, given_boxes):
    """With boxes given or found, CSRT stays within a few pixels of the truth: the seed paper's method at work."""
    boxes = boxes_around(frames[20].markers_px) if given_boxes else None
    tracker = BendingTracker(method="csrt", boxes=boxes)
    for frame in frames[20:26]:
        tracked = tracker.update(frame.image, frame.time_s)
    assert tracked.valid
    assert np.abs(tracked.markers.positions - frame.markers_px).max() < 5.0


def test_two_boxes_are_not_enough():
    """Boxes for two markers are refused with what is expected."""
    with pytest.raises(TrackerError, match="Found 2 boxes for CSRT; expected 3, from head to tail"):
        CsrtTracker(boxes=[(0, 0, 9, 9), (20, 0, 9, 9)])


def test_plain_opencv_is_told_what_to_install(monkeypatch):
    """Without the contrib build there is one sentence that says which package to install."""
    monkeypatch.delattr(cv2, "TrackerCSRT_create")
    with pytest.raises(TrackerError, match="Install opencv-contrib-python-headless"):
        CsrtTracker()


def test_unknown_method_is_refused():
    """A method that does not exist is named with those that do."""
    with pytest.raises(TrackerError, match="'kcf'; expected one of contour, moment, midline, apriltag, csrt"):
        BendingTracker(method="kcf")
