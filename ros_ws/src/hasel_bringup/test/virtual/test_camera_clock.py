# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Frames of a camera with a clock of its own."""

import numpy as np
import pytest
from hasel_bringup.virtual.seen_swimmer import CameraClock
from hypothesis import given
from hypothesis import strategies as st

OFF, ON = np.zeros(2), np.array([4500.0, 0.0])
FIRST_NS = 1_700_000_000_000_000_000


@pytest.fixture
def clock():
    """A hundred frames a second, from one state on."""
    clock = CameraClock(100.0)
    clock.begin(FIRST_NS, OFF)
    return clock


def taken(instants):
    """Milliseconds after the first state, volts of the upper muscle, and whether it is a frame."""
    return [((i.stamp_ns - FIRST_NS) / 1e6, i.voltage[0], i.is_frame) for i in instants]


def test_a_voltage_holds_until_the_next_state(clock):
    """Frames before it are under the old one, and the state's own instant is under its own."""
    assert taken(clock.until(FIRST_NS + 25_000_000, ON)) == [(10, 0, True), (20, 0, True), (25, 4500, False)]
    assert taken(clock.until(FIRST_NS + 30_000_000, OFF)) == [(30, 0, True)]


def test_a_state_that_is_no_later_changes_nothing(clock):
    """Neither frames nor voltage."""
    clock.until(FIRST_NS + 5_000_000, ON)
    assert clock.until(FIRST_NS + 5_000_000, OFF) == clock.until(FIRST_NS, OFF) == []
    assert taken(clock.until(FIRST_NS + 12_000_000, OFF)) == [(10, 4500, True), (12, 0, False)]


@given(st.lists(st.integers(1, 40_000_000), min_size=1, max_size=40), st.sampled_from([30.0, 95.0, 120.0]))
def test_frames_keep_their_rate_whatever_the_states(steps, frame_rate):
    """Every frame up to the last state once, in order; and every state."""
    clock = CameraClock(frame_rate)
    first = clock.begin(FIRST_NS, OFF)
    stamps = (FIRST_NS + np.cumsum(steps)).tolist()
    instants = [first, *(instant for stamp in stamps for instant in clock.until(stamp, ON))]
    found = [instant.stamp_ns for instant in instants]
    assert found == sorted(set(found))
    assert set(stamps) <= set(found)
    assert [i.stamp_ns for i in instants if i.is_frame] == clock.frames(FIRST_NS, stamps[-1]).tolist()
