import numpy as np
import pytest
from hasel_tracker.tracking.colour_gate import ColourRange
from hasel_tracker_lab.rendering.background import filling
from hasel_tracker_lab.rendering.degradation import Degradation
from hasel_tracker_lab.rendering.motion import BendingMotion
from hasel_tracker_lab.rendering.renderer import Renderer
from skimage import data, measure


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
