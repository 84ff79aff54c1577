# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from dataclasses import replace

import cv2
import numpy as np
import pytest
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.tracking.marker_contour import measure_contour
from hasel_tracker.tracking.marker_moment import measure_marker
from hasel_tracker.tracking.marker_tracker import MarkerTracker
from hasel_tracker.tracking.tracker_settings import ColourRange, TrackerSettings
from hasel_tracker_lab.rendering.camera_model import Degradation
from hasel_tracker_lab.rendering.renderer import Renderer
from hasel_tracker_lab.rendering.swimmer_motion import BendingMotion

WATER = (188, 196, 198)


def contour_tracker(settings: TrackerSettings = TrackerSettings()) -> MarkerTracker:  # noqa: B008
    """A tracker with the default method."""
    return MarkerTracker(settings, measure_contour)


@pytest.mark.parametrize("method", [measure_contour, measure_marker])
def test_follows_a_beat(frames, method):
    """Through a whole beat the markers stay within 0.15 px of the truth, in the right order, with high quality."""
    tracker = MarkerTracker(TrackerSettings(), method)
    for frame in frames:
        markers = tracker.update(frame.image, frame.time_s)
        assert np.abs(markers.positions - frame.markers_px).max() < 0.15
        assert markers.quality.min() > 0.7


def test_nothing_to_see_says_what_was_found():
    """An empty picture gives no markers, and a note that says why."""
    tracker = contour_tracker()
    markers = tracker.update(np.full((360, 640, 3), 190, np.uint8), 0.0)
    assert not markers.found.any()
    assert markers.quality.tolist() == [0.0, 0.0, 0.0]
    assert "found 0 blobs" in tracker.note


def test_lost_marker_is_nan_while_the_others_are_followed(renderer):
    """In the very frame in which the middle marker is covered it is NaN with quality 0; the others are right."""
    tracker = contour_tracker()
    tracker.update(renderer.frame(0.0).image, 0.0)
    hidden = renderer.frame(1 / 120, 1, hidden=(1,))
    markers = tracker.update(hidden.image, 1 / 120)
    assert markers.found.tolist() == [True, False, True]
    assert np.isnan(markers.positions[1]).all()
    assert markers.quality[1] == 0.0
    assert np.abs(markers.positions[[0, 2]] - hidden.markers_px[[0, 2]]).max() < 0.1


def test_half_covered_marker_is_lost_rather_than_wrong(renderer):
    """A marker half under something is not reported with the centre of its visible half."""
    tracker = contour_tracker()
    frame = renderer.frame(0.0)
    tracker.update(frame.image, 0.0)
    picture = renderer.frame(1 / 120, 1).image.copy()
    x, y = np.rint(frame.markers_px[2]).astype(int)
    cv2.rectangle(picture, (int(x), int(y) - 20), (int(x) + 20, int(y) + 20), WATER, cv2.FILLED)
    markers = tracker.update(picture, 1 / 120)
    assert markers.found.tolist() == [True, True, False]


@pytest.mark.parametrize(("length_px", "width_px"), [(40.0, 3.0), (15.0, 5.0)])
def test_reflection_across_a_marker_is_refused_or_harmless(length_px, width_px):
    """Whatever part of a marker a bright reflection covers, the marker is lost or off by less than a pixel."""
    frame = Renderer(BendingMotion(amplitude_rad=0.0), degradation=Degradation(noise_levels=2.0)).frame(0.0)
    tracker = contour_tracker()
    tracker.update(frame.image, 0.0)
    rows, columns = np.indices(frame.image.shape[:2])
    lost = 0
    for offset in range(-24, 25, 4):
        x, y = frame.markers_px[2] + [4.0, offset]
        streak = 200.0 * np.exp(-0.5 * (((rows - y) / width_px) ** 2 + ((columns - x) / length_px) ** 2))
        picture = np.clip(frame.image + streak[..., None], 0, 255).astype(np.uint8)
        markers = tracker.update(picture, 0.0)
        lost += not markers.found[2]
        assert not markers.found[2] or np.abs(markers.positions[2] - frame.markers_px[2]).max() < 1.0
    assert 1 <= lost <= 9


@pytest.mark.parametrize(("away_s", "kept"), [(0.3, False), (1.5, True)])
def test_swimmer_put_back_the_other_way_round(renderer, away_s, kept):
    """Taken out for over a second and put back turned round, its head is found anew; a short gap keeps the order."""
    turned = Renderer(renderer.motion, replace(renderer.view, roll_rad=np.pi)).frame(0.2)
    tracker = contour_tracker()
    before = renderer.frame(0.0)
    tracker.update(before.image, 0.0)
    for time_s in np.arange(0.05, away_s, 0.05):
        assert not tracker.update(np.full_like(before.image, 190), time_s).found.any()
    markers = tracker.update(turned.image, away_s)
    assert markers.found.all()
    head_is_head = np.abs(markers.positions[0] - turned.markers_px[0]).max() < 0.5
    assert bool(head_is_head) is kept


def test_dropped_frames_do_not_lose_a_fast_marker(frames):
    """With only every third frame the prediction goes by time, so that nothing is lost."""
    tracker = contour_tracker(TrackerSettings(region_px=8))
    for frame in frames[::3]:
        assert tracker.update(frame.image, frame.time_s).found.all()


def test_markers_of_another_colour(frames):
    """With the colour range set, green markers are followed as well as blue ones."""
    tracker = contour_tracker(TrackerSettings(colour=ColourRange(40, 80, 90, 35)))
    green = frames[30].image[..., [1, 0, 2]]
    markers = tracker.update(np.ascontiguousarray(green), 0.0)
    assert np.abs(markers.positions - frames[30].markers_px).max() < 0.2


def test_tracked_frame_reads_as_a_sentence(frames):
    """A result prints with its angle, or with which marker is lost."""
    tracker = BendingTracker()
    said = [str(tracker.update(frame.image, frame.time_s)) for frame in frames[:3]]
    assert "the markers were only just found" in said[0]
    assert "sin θ is" in said[2]
    lost = tracker.update(np.full_like(frames[0].image, 190), 3 / 120)
    assert not lost.valid
    assert str(lost).endswith("head and middle and tail lost.")


@pytest.mark.parametrize("image", [np.zeros((90, 160), np.uint8), np.zeros((90, 160, 3), np.float32)])
def test_wrong_kind_of_image_is_refused(image):
    """A grey or floating-point image is named for what it is."""
    with pytest.raises(Exception, match="expected 8-bit colour in BGR order"):
        BendingTracker().update(image, 0.0)
