# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest
from hasel_tracker.tracking.tracker_settings import ColourRange
from hasel_tracker_lab.rendering.camera_model import CameraView, Degradation
from hasel_tracker_lab.rendering.renderer import Renderer, filling, marker_coverage
from hasel_tracker_lab.rendering.swimmer_motion import BendingMotion
from skimage import data, measure

CENTRE = np.array([0.0123, -0.0071])


def test_markers_are_where_the_truth_says(renderer):
    """An independent library (scikit-image) finds three blue regions at the true positions, and nothing else."""
    frame = renderer.frame(0.2)
    regions = measure.regionprops(measure.label(ColourRange().mask(frame.image) > 0))
    centres = sorted([region.centroid[1], region.centroid[0]] for region in regions if region.area > 10)
    assert np.abs(np.array(centres) - frame.markers_px).max() < 0.5


def test_hidden_marker_is_not_drawn(renderer):
    """A marker that is hidden leaves no blue in the picture where it would be."""
    x, y = np.rint(renderer.frame(0.2).markers_px[2]).astype(int)
    blue = ColourRange().mask(renderer.frame(0.2, hidden=(2,)).image)
    assert blue[y - 8 : y + 8, x - 8 : x + 8].max() == 0
    assert blue.max() == 255


def test_motion_blur_smears_along_the_motion():
    """A longer exposure widens a moving marker across the body, by about speed times exposure."""
    motion = BendingMotion(amplitude_rad=1.0, frequency_hz=4.0)
    heights = []
    for exposure in (0.0, 0.006):
        chain = Degradation(exposure_s=exposure)
        frame = Renderer(motion, degradation=chain).frame(0.25)
        x, y = np.rint(frame.markers_px[2]).astype(int)
        region = frame.image[y - 60 : y + 60, x - 60 : x + 60].astype(float)
        share = np.clip((region[..., 0] - region[..., 2] - 10.0) / 136.0, 0.0, 1.0)
        rows = np.indices(share.shape)[0]
        middle = (share * rows).sum() / share.sum()
        heights.append(np.sqrt(12.0 * (share * (rows - middle) ** 2).sum() / share.sum()))
    shift = np.diff([Renderer(motion).frame(t).markers_px[2, 1] for t in (0.247, 0.253)])[0]
    assert np.sqrt(heights[1] ** 2 - heights[0] ** 2) == pytest.approx(abs(shift), rel=0.15)


def test_photograph_lies_behind_the_swimmer(renderer):
    """Away from the body the picture is the photograph, but for the optics' blur."""
    photograph = filling(data.coffee()[..., ::-1], 640, 360)
    picture = Renderer(renderer.motion, renderer.view, background=photograph).frame(0.0).image
    assert np.abs(picture[:60].astype(float) - photograph[:60]).mean() < 4.0
    assert np.abs(picture[170:190].astype(float) - photograph[170:190]).mean() > 20.0


def test_texture_of_the_skin_is_carried_along(renderer):
    """A photograph on the skin shows on the body, moves with it, and leaves water and markers as they are."""
    skin = filling(data.brick(), 640, 360)
    drawn = Renderer(BendingMotion(0.0, drift_m_per_s=-0.1), renderer.view, skin=skin)
    plain = Renderer(drawn.motion, renderer.view)
    before, after = drawn.frame(0.0).image.astype(float), drawn.frame(0.1).image.astype(float)
    difference = np.abs(before - plain.frame(0.0).image).mean(axis=2)
    assert difference[172:188, 120:300].mean() > 5.0
    assert difference[:100].max() < 2.0
    shift = round(0.1 * 0.1 * renderer.view.pixels_per_m)
    assert np.abs(after[172:178, 120 + shift : 300 + shift] - before[172:178, 120:300]).mean() < 2.0


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
