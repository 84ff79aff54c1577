"""Tags that say which marker they are."""

from dataclasses import replace

import numpy as np
from hasel_tracker.lab.lab_scene import LabScene
from hasel_tracker.lab.lab_swimmer import LabSwimmer
from hasel_tracker.tracking.apriltag_tracker import AprilTagTracker
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.tracking.doubt import Doubt

SWIMMER = LabSwimmer(tags=True, dot_radius_px=20.0, bend_rad=0.5, half_width_px=45.0)


def test_tags_are_found_from_the_first_frame_on():
    """No start, no head to guess: the first frame has the angle, and tags of 48 px are right to half a pixel."""
    tracker = BendingTracker(method="apriltag")
    for frame in LabScene((SWIMMER,), exposure_s=0.0).frames(4):
        tracked = tracker.update(frame.image, frame.time_s)
        assert tracked.valid
        assert np.abs(tracked.markers.positions - frame.dots_px).max() < 0.5
        assert abs(tracked.sin_theta - frame.sin_theta) < 2e-3


def test_a_tag_in_view_twice_is_in_doubt():
    """Two swimmers with the same tags: no angle rather than a mixed one."""
    both = (replace(SWIMMER, start_px=(320.0, 180.0)), replace(SWIMMER, start_px=(320.0, 520.0)))
    frame = LabScene(both, exposure_s=0.0).frame(0.0)
    assert AprilTagTracker().update(frame.image, 0.0).doubt is Doubt.AMBIGUOUS
    assert not BendingTracker(method="apriltag").update(frame.image, 0.0).valid
