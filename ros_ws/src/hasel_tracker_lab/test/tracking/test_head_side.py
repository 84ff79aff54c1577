import numpy as np
import pytest
from hasel_tracker.tracking.body_link import BodyLink, body_link
from hasel_tracker.tracking.head_side import head_word, nearer_to, on_side, thicker_first
from hasel_tracker_lab.rendering.camera_model import CameraView, Degradation
from hasel_tracker_lab.rendering.renderer import Renderer
from hasel_tracker_lab.rendering.swimmer_motion import BendingMotion


@pytest.mark.parametrize("roll", np.radians([0.0, 70.0, 180.0, 250.0]))
@pytest.mark.parametrize("bend_time_s", [0.0, 0.14, 0.36])
def test_head_is_the_end_before_the_thicker_half(roll, bend_time_s):
    """However the swimmer lies and bends, the head is told from the tail by the body's thickness."""
    view = CameraView(960, 960, 3600.0, roll_rad=float(roll))
    frame = Renderer(BendingMotion(), view, degradation=Degradation(noise_levels=3.0)).frame(bend_time_s)
    head, middle, tail = frame.markers_px
    links = tuple(body_link(frame.image, *pair, 7.2) for pair in ((head, middle), (middle, tail)))
    assert (thicker_first(links), thicker_first(links[::-1])) == (True, False)


@pytest.mark.parametrize(
    ("side", "first"), [("left", True), ("right", False), ("top", False), ("bottom", True)]
)
def test_side_as_set(side, first):
    """A side that is set says which end it is."""
    row = np.array([[100.0, 300.0], [300.0, 200.0], [500.0, 100.0]])
    assert on_side(row, side) is first


def test_point_near_the_head():
    """A point that is set says which end is nearer to it."""
    row = np.array([[100.0, 300.0], [300.0, 200.0], [500.0, 100.0]])
    assert nearer_to(row, head_word("90,310"))
    assert not nearer_to(row, head_word("480, 150"))
    with pytest.raises(ValueError, match="could not convert"):
        head_word("upwards")


@pytest.mark.parametrize("widths", [(30.0, 28.0), (30.0, 21.0), (0.0, 30.0), (float("nan"), 30.0)])
def test_halves_that_look_alike_are_not_guessed(widths):
    """Where the two halves are about equally thick, or one cannot be measured, there is no answer."""
    assert thicker_first(tuple(BodyLink(9.0, width) for width in widths)) is None
