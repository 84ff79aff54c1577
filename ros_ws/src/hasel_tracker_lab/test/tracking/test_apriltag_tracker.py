# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Tags that say which marker they are."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hasel_tracker.tracking.apriltag_tracker import AprilTagTracker
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker_lab.scenes.lab_scene import LabScene
from hasel_tracker_lab.scenes.lab_swimmer import LabSwimmer

SWIMMER = LabSwimmer(tags=True, dot_radius_px=20.0, bend_rad=0.5, half_width_px=45.0)


@pytest.mark.parametrize(("side_px", "right_to_px"), [(24, 0.15), (48, 0.04), (60, 0.04)])
def test_tags_are_found_from_the_first_frame_on(side_px, right_to_px):
    """No start, no head to guess: the first frame has the angle; tags of 60 px are right to 0.04 px rms and better."""
    tracker = BendingTracker(method="apriltag")
    errors, said = [], []
    swimmer = replace(SWIMMER, dot_radius_px=side_px / 2.4, heading_rad=0.2, drift_px_s=(70.0, 40.0))
    for frame in LabScene((swimmer,), exposure_s=0.0, frame_rate_hz=30.0).frames(5):
        tracked = tracker.update(frame.image, frame.time_s)
        assert tracked.valid
        assert abs(tracked.sin_theta - frame.sin_theta) < 1e-3
        errors.append(tracked.markers.positions - frame.dots_px)
        said.append(tracked.markers.sigma_px)
    rms = np.sqrt(np.square(errors).sum(axis=2).mean())
    assert rms < right_to_px
    assert rms / 4 < np.mean(said) < 2 * rms


def test_something_over_a_side_moves_a_tag_little():
    """A black tether across the white rim and border: the tag is right to half a pixel, or lost."""
    frame = LabScene((SWIMMER,), exposure_s=0.0).frame(0.0)
    x = frame.dots_px[1, 0]
    for offset in (-30.0, -24.0, -12.0):
        image = frame.image.copy()
        cv2.line(image, (int(x + offset), 0), (int(x + offset) + 6, 719), (35, 33, 30), 4, cv2.LINE_AA)
        markers = AprilTagTracker().update(image, 0.0)
        assert not markers.found[1] or np.linalg.norm(markers.positions[1] - frame.dots_px[1]) < 0.5


def test_a_tag_in_view_twice_is_in_doubt():
    """Two swimmers with the same tags: no angle rather than a mixed one."""
    both = (replace(SWIMMER, start_px=(320.0, 180.0)), replace(SWIMMER, start_px=(320.0, 520.0)))
    frame = LabScene(both, exposure_s=0.0).frame(0.0)
    assert AprilTagTracker().update(frame.image, 0.0).doubt is Doubt.AMBIGUOUS
    assert not BendingTracker(method="apriltag").update(frame.image, 0.0).valid
