# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Two to fifteen markers, in order along the body, in pixels and metres."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_recording import read_recording
from hasel_tracker.calibration.camera_calibration import CameraCalibration
from hasel_tracker.offline.run_output import write_run
from hasel_tracker.offline.tracked_run import TrackedRun, track_frames
from hasel_tracker.sources.frame import Frame
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.tracking.marker_set import bending_angle, marker_names
from hasel_tracker.tracking.tracker_settings import TrackerSettings
from hasel_tracker_lab.scenes.lab_scene import LabScene
from hasel_tracker_lab.scenes.lab_swimmer import LabSwimmer

SCALE_M = 0.0002  # metres per pixel
SWIMMER = LabSwimmer(length_px=1000.0, start_px=(140.0, 360.0), bend_rad=0.6, dot_radius_px=8.0, fin_from=1.1)


def tracked(count: int, calibration: CameraCalibration | None = None) -> tuple[TrackedRun, list]:
    """Five frames of a swimmer with so many dots, and the truth."""
    swimmer = replace(SWIMMER, stations=tuple(np.linspace(0.05, 0.95, count)))
    pictures = list(LabScene((swimmer,), exposure_s=0.0).frames(5))
    # A single stretch of body between two dots does not tell the head from the tail.
    head = "left" if count == 2 else "auto"
    tracker = BendingTracker(TrackerSettings(marker_count=count, head=head), calibration=calibration)
    return track_frames(
        (Frame(i, p.time_s, image=p.image) for i, p in enumerate(pictures)), tracker
    ), pictures


@pytest.mark.parametrize("count", [2, 3, 4, 7, 15])
def test_all_are_found_in_order(count):
    """So many dots on a tapered body are found without help, head first, to a tenth of a pixel."""
    run, pictures = tracked(count)
    assert run.valid.all()
    assert np.abs(run.markers_px - [picture.dots_px for picture in pictures]).max() < 0.15


def test_metres_reach_the_recording(tmp_path):
    """With a calibration the recording holds the positions in metres, y up, under the markers' names."""
    plane = np.diag([SCALE_M, SCALE_M, 1.0])
    run, pictures = tracked(5, CameraCalibration((1280, 720), np.eye(3), np.zeros(5), plane, 0.0))
    for name in ("run.csv", "run.mcap"):
        write_run(tmp_path / name, run, None, None, {})
        recording = read_recording(tmp_path / name)
        assert recording.marker_unit == "m"
        assert recording.marker_names == ("head", "body_1", "middle", "body_3", "tail")
        expected = np.array([picture.dots_px for picture in pictures]) * SCALE_M * [1.0, -1.0]
        assert np.abs(recording.markers - expected).max() < 0.2 * SCALE_M


def test_names_in_order():
    """The ends are head and tail, the one half-way is the middle, the others are numbered from the head."""
    assert marker_names(2) == ("head", "tail")
    assert marker_names(3) == ("head", "middle", "tail")
    assert marker_names(4) == ("head", "body_1", "body_2", "tail")


def test_angle_of_two_and_of_an_even_number():
    """Two markers turn against the direction at rest; of four the point between the inner two is the middle."""
    up = np.radians(20.0)
    pair = np.array([[0.0, 0.0], [np.cos(up), -np.sin(up)]])
    assert bending_angle(pair)[0] == pytest.approx(np.sin(up))
    assert bending_angle(pair, rest_direction_deg=20.0)[0] == pytest.approx(0.0, abs=1e-12)
    three = np.array([[0.0, 0.0], [10.0, 1.0], [20.0, -3.0]])
    four = np.array([three[0], [8.0, 0.5], [12.0, 1.5], three[2]])
    assert bending_angle(four)[0] == pytest.approx(bending_angle(three)[0])
