# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_tracker.calibration.camera_calibration import (
    Board,
    CameraCalibration,
    calibrate_camera,
    find_corners,
)
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.marker_set import bending_angle
from hasel_tracker_lab.rendering.camera_model import CameraView
from hasel_tracker_lab.rendering.renderer import board_picture
from hasel_tracker_lab.rendering.swimmer_motion import BendingMotion

BOARD = Board(9, 6, 0.012)
SIZE = (640, 360)
POSES = [(0.0, 0.0, 0.0), (0.4, 0.0, 0.0), (-0.35, 0.3, 0.1), (0.1, -0.4, -0.2), (0.2, 0.35, 1.6)]


def view_of(pose: tuple[float, float, float], lens: float = -0.25) -> CameraView:
    """A wide-angle camera with a curved lens in a pose (tilt, pan, roll) [rad]."""
    tilt, pan, roll = pose
    return CameraView(*SIZE, 2400.0, 0.25, tilt, roll, pan, lens)


def corners_of(view: CameraView) -> np.ndarray:
    """Corners found in a rendered picture of the board."""
    return find_corners(board_picture(view, BOARD.columns, BOARD.rows, BOARD.square_m), BOARD, "the picture")


@pytest.fixture(scope="module")
def calibration() -> CameraCalibration:
    """Lens from five poses; the plane is seen at a slant."""
    views = [corners_of(view_of(pose)) for pose in POSES]
    return calibrate_camera(views, views[1], BOARD, SIZE)


def test_lens_is_recovered(calibration):
    """The focal length is that of the pictures, and points are straightened by as much as the lens bent them."""
    view = view_of(POSES[0])
    focal = view.camera_matrix[0, 0]
    points = np.random.default_rng(1).uniform([120.0, 60.0], [520.0, 300.0], (50, 2))
    true = CameraCalibration(SIZE, view.camera_matrix, view.distortion, np.eye(3), 0.0).undistorted(points)
    assert calibration.camera_matrix[0, 0] == pytest.approx(focal, rel=0.01)
    bent = np.sqrt(((true - points) ** 2).mean())
    assert bent > 0.8
    assert np.sqrt(((calibration.undistorted(points) - true) ** 2).mean()) < 0.2 * bent
    assert calibration.error_px < 0.1


def test_distances_in_the_plane_are_true(calibration):
    """Points 50 mm apart in the plane are measured so to 0.1 mm, anywhere in the picture."""
    points = np.array([[-0.06, 0.0], [-0.01, 0.0], [0.02, 0.03], [0.02, -0.02]])
    seen = view_of(POSES[1]).to_pixels(points)
    plane = calibration.to_plane(seen, SIZE)
    assert np.linalg.norm(plane[0] - plane[1]) == pytest.approx(0.05, abs=1e-4)
    assert np.linalg.norm(plane[2] - plane[3]) == pytest.approx(0.05, abs=1e-4)


@pytest.mark.parametrize("bend", [-0.8, 0.3, 1.0])
def test_angle_is_true_after_calibration_and_keeps_its_sign(calibration, bend):
    """Seen at a slant through a curved lens, the calibrated angle is right to 0.002; the raw one is not."""
    markers = 0.7 * BendingMotion().markers_when_bent(bend)
    seen = view_of(POSES[1]).to_pixels(markers)
    truth, _ = bending_angle(markers * [1.0, -1.0])
    calibrated, _ = bending_angle(calibration.to_plane(seen, SIZE))
    raw, _ = bending_angle(seen)
    assert calibrated == pytest.approx(truth, abs=0.002)
    assert abs(raw - truth) > 0.01


@pytest.mark.parametrize("roll", [0.0, 1.6, 3.1])
def test_sign_does_not_depend_on_how_the_board_lies(roll):
    """However the board is turned in the plane, the angle keeps its sign; a single view gives perspective alone."""
    corners = corners_of(view_of((0.1, 0.0, roll), lens=0.0))
    calibration = calibrate_camera([corners], corners, BOARD, SIZE)
    markers = 0.7 * BendingMotion().markers_when_bent(0.5)
    seen = view_of((0.1, 0.0, 0.2), lens=0.0).to_pixels(markers)
    assert not calibration.distortion.any()
    assert bending_angle(calibration.to_plane(seen, SIZE))[0] > 0.2


def test_saved_and_loaded(calibration, tmp_path):
    """A calibration file gives back the same numbers."""
    path = tmp_path / "camera.yaml"
    calibration.save(path)
    loaded = CameraCalibration.load(path)
    points = np.array([[100.0, 50.0], [np.nan, np.nan], [600.0, 300.0]])
    assert np.array_equal(loaded.to_plane(points, SIZE), calibration.to_plane(points, SIZE), equal_nan=True)
    assert "fit to" in str(loaded)


def test_picture_without_board_is_explained():
    """A picture that does not show the board is named, with what to do."""
    with pytest.raises(TrackerError, match=r"No board of 9 × 6 inner corners is seen in table\.png"):
        find_corners(np.full((360, 640, 3), 128, np.uint8), BOARD, "table.png")


def test_other_image_size_is_refused(calibration):
    """A calibration made at another size is not applied."""
    with pytest.raises(TrackerError, match="calibration was made at 640 × 360 px"):
        calibration.to_plane(np.zeros((3, 2)), (1920, 1080))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("camera_matrix: [1]", "lacks image_size_px"),
        ("{:", "cannot be read"),
        ("\n".join(f"{key}: [1]" for key in ("image_size_px", "camera_matrix", "distortion", "pixel_to_plane"))
         + "\nerror_px: 0", "wrong size or kind"),
    ],
)  # fmt: skip
def test_damaged_file_is_explained(tmp_path, text, message):
    """A calibration file that lacks something says what."""
    path = tmp_path / "camera.yaml"
    path.write_text(text)
    with pytest.raises(TrackerError, match=message):
        CameraCalibration.load(path)
