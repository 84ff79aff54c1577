import cv2
import numpy as np
import pytest
from hasel_tracker_lab.rendering.camera_view import CameraView
from hasel_tracker_lab.rendering.marker_coverage import marker_coverage

CENTRE = np.array([0.0123, -0.0071])


def test_area_and_centre_of_a_disc():
    """Seen from straight above, the coverage adds up to π r² and its centre is the projected one to 0.001 px."""
    view = CameraView()
    middle = view.to_pixels(CENTRE[None])[0]
    corner = (int(middle[0]) - 20, int(middle[1]) - 20)
    coverage = marker_coverage(view, CENTRE, 0.002, corner, 41)
    rows, columns = np.indices(coverage.shape)
    centre = np.array([(coverage * columns).sum(), (coverage * rows).sum()]) / coverage.sum() + corner
    assert coverage.sum() == pytest.approx(np.pi * 12.0**2, rel=1e-3)
    assert np.abs(centre - middle).max() < 1e-3


def test_tilted_disc_agrees_with_a_drawn_polygon():
    """Under perspective and through a lens, the coverage is that of the projected outline as OpenCV draws it."""
    view = CameraView(tilt_rad=0.4, radial_distortion=-0.2)
    angle = np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)
    outline = view.to_pixels(CENTRE + 0.002 * np.column_stack([np.cos(angle), np.sin(angle)]))
    corner = np.floor(outline.min(axis=0)).astype(int) - 3
    coverage = marker_coverage(view, CENTRE, 0.002, (int(corner[0]), int(corner[1])), 36)
    fine = 8
    drawn = np.zeros((36 * fine, 36 * fine), np.uint8)
    cv2.fillPoly(drawn, [np.rint(((outline - corner + 0.5) * fine - 0.5) * 256).astype(np.int32)], 1, shift=8)
    expected = drawn.reshape(36, fine, 36, fine).mean(axis=(1, 3))
    assert coverage.sum() == pytest.approx(expected.sum(), rel=0.03)
    assert np.abs(coverage - expected).mean() < 0.01
