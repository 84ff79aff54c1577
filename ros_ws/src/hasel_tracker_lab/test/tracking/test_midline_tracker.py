# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Points along the centre line from frame to frame, and when there are none."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.bending_tracker import BendingTracker, TrackedFrame
from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker.tracking.tracker_settings import TrackerSettings
from hasel_tracker_lab.scenes.lab_scene import LabScene
from hasel_tracker_lab.scenes.scene_catalogue import ALIKE, BARE, SHARES

STRAIGHT = replace(BARE, bend_rad=0.0)


def tracked(scene: LabScene, times: list[float], tracker: BendingTracker) -> list[TrackedFrame]:
    """What the tracker says to the scene at these times."""
    return [tracker.update(scene.frame(time).image, time) for time in times]


def midline(**settings: object) -> BendingTracker:
    """A tracker by the midline."""
    return BendingTracker(replace(SHARES, **settings), "midline")


def test_points_are_where_the_markers_of_the_swimmer_would_be():
    """Three points at 5, 94 and 190 of 190 mm by default; of another number evenly from there to the tail."""
    assert TrackerSettings().shares == pytest.approx((5 / 190, 94 / 190, 1.0))
    assert TrackerSettings(marker_count=4).shares == pytest.approx((5 / 190, 0.3509, 0.6754, 1.0), abs=1e-4)
    frame = LabScene((STRAIGHT,)).frame(0.0)
    tracker = BendingTracker(TrackerSettings(marker_count=5), "midline")
    points = tracker.update(frame.image, 0.0).markers.positions
    assert points[:, 0] == pytest.approx(
        320.0 + 640.0 * np.array(TrackerSettings(marker_count=5).shares), abs=1.5
    )
    assert points[:, 1] == pytest.approx(np.full(5, 360.0), abs=0.3)


def test_two_more_frames_must_agree():
    """The first frames are in doubt and vouched for by the third."""
    frames = tracked(LabScene((BARE,)), [0.0, 1 / 120, 2 / 120], midline())
    assert [each.markers.doubt for each in frames] == [Doubt.STARTING, Doubt.STARTING, Doubt.NONE]
    assert frames[2].valid
    assert frames[2].markers.vouches_for == 2


def test_a_covered_tail_gives_no_angle_however_long():
    """A silhouette that becomes shorter is in doubt for as long as it is, over a second too, and then right again."""
    hidden = replace(BARE, hidden=((2, 0.1, 1.5),), cover_colour=(170.0, 175.0, 168.0))
    times = [0.0, 0.01, 0.02, *np.arange(0.12, 1.5, 0.25), 1.51, 1.52, 1.53]
    scene, tracker = LabScene((hidden,), shadow=0.0, exposure_s=0.0), midline()
    frames = tracked(scene, times, tracker)
    assert [each.valid for each in frames] == [False, False, True, *[False] * 6, False, False, True]
    assert {each.markers.doubt for each in frames[3:9]} == {Doubt.JUMP}


def test_what_was_covered_at_the_start_counts_once_it_is_seen_for_a_second():
    """A body that is longer than it was for over a second is taken anew, with its whole length."""
    hidden = replace(STRAIGHT, hidden=((2, 0.0, 0.05),), cover_colour=(170.0, 175.0, 168.0))
    times = [0.0, 0.01, 0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 1.2, 1.21, 1.22]
    frames = tracked(LabScene((hidden,), shadow=0.0, exposure_s=0.0), times, midline())
    assert [each.markers.doubt for each in frames[3:8]] == [Doubt.JUMP] * 5
    assert frames[-1].valid
    assert frames[-1].markers.positions[2, 0] == pytest.approx(320.0 + 0.97 * 640.0, abs=1.5)


@pytest.mark.parametrize(
    ("scene", "note"),
    [
        (LabScene((replace(BARE, start_px=(-50.0, 360.0)),)), "touches the edge"),
        (LabScene((replace(BARE, start_px=(300.0, 200.0)), BARE)), "2 things stand out"),
        (LabScene((ALIKE,)), "say where the head is with --head"),
        (LabScene(()), "no body stands out"),
    ],
)
def test_why_there_is_no_angle(scene, note):
    """Each reason is told."""
    tracker = midline()
    frames = tracked(scene, [0.0, 0.01, 0.02], tracker)
    assert not any(each.valid for each in frames)
    assert note in tracker.note


def test_head_and_region_as_told():
    """--head turns the line round where halves are alike; --roi leaves one of two swimmers out."""
    scene = LabScene((ALIKE,))
    for head, x in (("left", 352.0), ("right", 928.0), ("900,300", 928.0)):
        assert tracked(scene, [0.0], midline(head=head))[0].markers.positions[0, 0] == pytest.approx(
            x, abs=2.0
        )
    both = LabScene((replace(BARE, start_px=(300.0, 160.0)), replace(BARE, start_px=(300.0, 560.0))))
    tracker = BendingTracker(SHARES, "midline", roi=(0, 0, 1280, 360))
    assert tracked(both, [0.0, 0.01, 0.02], tracker)[-1].valid


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"body": "grey"}, "expected one of auto, light, dark"),
        ({"points": "0.5,0.1,1"}, "expected rising shares"),
        ({"points": "a,b,c"}, "expected rising shares"),
        ({"points": "0,1"}, "Found 2 shares of the length for 3 points"),
    ],
)
def test_settings_that_cannot_be(settings, message):
    """Bad settings get one sentence."""
    with pytest.raises(TrackerError, match=message):
        TrackerSettings(**settings)
