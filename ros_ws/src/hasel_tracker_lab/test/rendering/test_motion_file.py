# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_recording import Recording, write_recording
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.marker_set import bending_angle
from hasel_tracker_lab.rendering.motion_file import read_motion
from hasel_tracker_lab.rendering.swimmer_motion import BodyShape, points_at

SHAPE = BodyShape()
TIMES = np.linspace(0.0, 0.5, 11)
SINES = 0.4 * np.sin(2.0 * np.pi * 2.0 * TIMES)


def markers_at(motion, time_s: float) -> np.ndarray:
    """Marker positions of a motion [m]."""
    return points_at(motion.centre_line(time_s), np.array(SHAPE.marker_stations_m), SHAPE.total_length_m)


@pytest.mark.parametrize("suffix", ["csv", "mcap"])
def test_angle_alone_makes_a_body_that_bends_so(tmp_path, suffix):
    """From a recording with sin θ only, the drawn body has that sin θ in every frame."""
    path = tmp_path / f"run.{suffix}"
    write_recording(Recording("run", TIMES, SINES), path)
    motion = read_motion(path, SHAPE)
    found = [bending_angle(markers_at(motion, t) * [1.0, -1.0])[0] for t in TIMES]
    assert found == pytest.approx(SINES.tolist(), abs=1e-3)


def test_markers_in_metres_are_kept(tmp_path):
    """From a recording with markers, their distances are kept; the body is moved into view."""
    markers = np.array([[[0.0, 0.0], [0.088, 0.002 * k], [0.17, -0.003 * k]] for k in range(11)]) + 5.0
    write_recording(Recording("run", TIMES, SINES, markers=markers), tmp_path / "run.csv")
    motion = read_motion(tmp_path / "run.csv", SHAPE)
    found = markers_at(motion, TIMES[7])
    assert np.diff(found, axis=0) == pytest.approx(np.diff(markers[7], axis=0), abs=1e-6)
    assert np.abs(found).max() < 0.2


def test_centre_lines_from_columns(tmp_path):
    """Columns centre_0_x_m … give the points of the centre line themselves."""
    stations = np.linspace(0.0, 0.19, 6)
    names = ",".join(f"centre_{k}_x_m,centre_{k}_y_m" for k in range(6))
    rows = [",".join(f"{x},{0.1 * t * x}" for x in stations) for t in (0.0, 1.0)]
    path = tmp_path / "lines.csv"
    path.write_text(f"time_s,{names}\n0,{rows[0]}\n1,{rows[1]}\n")
    motion = read_motion(path, SHAPE)
    line = motion.centre_line(1.0)
    assert line[:, 1] - line[0, 1] == pytest.approx(0.1 * stations)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("time_s,centre_0_x_m,centre_0_y_m\n0,1,2\n1,2,3\n", "does not hold whole centre lines"),
        ("time_s,sin_theta\n0,0.1\n", "a motion needs at least two"),
        ("time,angle\n0,1\n", "time_s"),
    ],
)
def test_unusable_files_are_explained(tmp_path, text, message):
    """What is wrong with a file is said in one sentence."""
    path = tmp_path / "motion.csv"
    path.write_text(text)
    with pytest.raises(TrackerError, match=message):
        read_motion(path, SHAPE)
