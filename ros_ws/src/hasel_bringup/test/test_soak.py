# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which frames the soak compares."""

import numpy as np
from hasel_bringup.soak import between_states

MS = 1_000_000


def test_frames_in_a_gap_of_the_states_are_left_out():
    """Those between near states, and on any state, are not; before the first and after the last nothing is known."""
    states = np.array([0, 10, 20, 150, 160]) * MS
    frames = np.array([-5, 0, 8, 17, 25, 140, 150, 155, 165]) * MS
    compared = between_states(frames, states, 0.1)
    assert (frames[compared] // MS).tolist() == [0, 8, 17, 150, 155]
