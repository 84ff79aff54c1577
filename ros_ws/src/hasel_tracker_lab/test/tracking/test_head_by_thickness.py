# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_tracker.tracking.body_link import body_link
from hasel_tracker.tracking.head_order import thicker_first
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
