import numpy as np
import pytest
from hasel_tracker.render.camera_view import CameraView
from hasel_tracker.render.degradation import Degradation
from hasel_tracker.render.motion import BendingMotion
from hasel_tracker.render.renderer import Renderer
from hasel_tracker.tracking.head_side import starts_at_head


@pytest.mark.parametrize("roll", np.radians([0.0, 70.0, 180.0, 250.0]))
@pytest.mark.parametrize("bend_time_s", [0.0, 0.14, 0.36])
def test_head_is_the_end_before_the_thicker_half(roll, bend_time_s):
    """However the swimmer lies and bends, the head is told from the tail by the body's thickness."""
    view = CameraView(960, 960, 3600.0, roll_rad=float(roll))
    frame = Renderer(BendingMotion(), view, degradation=Degradation(noise_levels=3.0)).frame(bend_time_s)
    first, why = starts_at_head(frame.image, frame.markers_px, "auto")
    reverse, _ = starts_at_head(frame.image, frame.markers_px[::-1], "auto")
    assert (first, reverse) == (True, False)
    assert "thicker" in why


@pytest.mark.parametrize(
    ("side", "first"), [("left", True), ("right", False), ("top", False), ("bottom", True)]
)
def test_side_as_set(side, first):
    """A side that is set decides whatever the picture shows."""
    row = np.array([[100.0, 300.0], [300.0, 200.0], [500.0, 100.0]])
    assert starts_at_head(np.zeros((400, 600, 3), np.uint8), row, side)[0] is first


def test_featureless_body_falls_back_to_the_left_and_says_so():
    """Without a body to be seen the left end is taken for the head, and the note says that this is a guess."""
    row = np.array([[500.0, 200.0], [300.0, 200.0], [100.0, 200.0]])
    first, why = starts_at_head(np.full((400, 600, 3), 180, np.uint8), row, "auto")
    assert not first
    assert "left end is taken" in why
