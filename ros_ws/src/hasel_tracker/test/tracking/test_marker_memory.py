# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is kept of the markers from frame to frame."""

import numpy as np
import pytest
from hasel_tracker.tracking.marker_memory import MarkerMemory
from hasel_tracker.tracking.marker_set import MarkerMeasurement

START = np.array([[100.0, 300.0], [300.0, 300.0], [500.0, 300.0]])
SPEED = np.array([[0.0, 0.0], [60.0, 0.0], [0.0, -120.0]])  # px/s


def memory() -> MarkerMemory:
    """Three markers seen at time zero."""
    return MarkerMemory([MarkerMeasurement(each, 450.0, 90.0, 0.1, 1.0) for each in START], 0.0, 16)


def test_markers_are_predicted_by_their_speed_and_a_lost_one_for_two_frames():
    """Seen markers go on as they went; a lost one is expected no farther than two frames on."""
    known, areas = memory(), np.full(3, 450.0)
    for number in (1, 2):
        time_s = 0.01 * number
        known.remember(START + SPEED * time_s, areas, known.predicted(time_s), time_s, sure=True)
    assert known.predicted(0.03) == pytest.approx(START + SPEED * 0.03)
    lost = START + SPEED * 0.03
    lost[2] = np.nan
    for number in (3, 4, 5, 6):
        lost[:2] = (START + SPEED * 0.01 * number)[:2]
        known.remember(lost, areas, known.predicted(0.01 * number), 0.01 * number, sure=False)
    assert known.seen.tolist() == [True, True, False]
    assert known.predicted(0.07)[2] == pytest.approx((START + SPEED * 0.04)[2])


def test_sizes_and_distances_are_learned_only_when_sure():
    """In doubt nothing is learned of sizes and distances."""
    known = memory()
    wider = START + [[0.0, 0.0], [0.0, 0.0], [20.0, 0.0]]
    known.remember(wider, np.full(3, 500.0), START, 0.01, sure=False)
    assert known.chords_px == pytest.approx([200.0, 200.0])
    known.remember(wider, np.full(3, 500.0), START, 0.02, sure=True)
    assert 200.0 < known.chords_px[1] < 205.0
    assert 450.0 < known.areas[0] < 460.0


def test_reach_grows_with_what_prediction_misses():
    """A jump by 30 px lets the next be twice as far, but never near the next marker."""
    known = memory()
    known.remember(START + [0.0, 30.0], np.full(3, 450.0), START, 0.01, sure=True)
    assert known.reach_px == pytest.approx(60.0)
    known.remember(START + [0.0, 90.0], np.full(3, 450.0), START, 0.02, sure=True)
    assert known.reach_px == pytest.approx(0.4 * known.chords_px.min(), rel=1e-3)
