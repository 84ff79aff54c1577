# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import colorsys

import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.tracker_settings import (
    ColourRange,
    TrackerSettings,
    load_settings,
    save_settings,
    settings_from,
)


def test_range_agrees_with_another_conversion():
    """The mask is that of Python's own RGB to HSV conversion, but for rounding at the borders."""
    random = np.random.default_rng(1)
    image = random.integers(0, 256, (60, 60, 3), dtype=np.uint8)
    mask = ColourRange(98, 130, 90, 35).mask(image) > 0
    differing = 0
    for pixel, inside in zip(image.reshape(-1, 3), mask.ravel(), strict=True):
        hue, saturation, value = colorsys.rgb_to_hsv(*(pixel[::-1] / 255.0))
        expected = 98 <= 180 * hue <= 130 and 255 * saturation >= 90 and 255 * value >= 35
        differing += expected != inside
    assert 50 < mask.sum() < 3000
    assert differing < 0.02 * mask.size


def test_red_wraps_around_the_hue_circle():
    """A range from 170 to 10 takes reds on both sides of zero and nothing else."""
    red, crimson, green = [0, 0, 220], [40, 0, 220], [0, 220, 0]
    mask = ColourRange(170, 10, 90, 35).mask(np.array([[red, crimson, green]], np.uint8))
    assert mask.tolist() == [[255, 255, 0]]


def test_impossible_range_is_refused():
    """A hue that OpenCV does not have is named, with what is allowed."""
    with pytest.raises(TrackerError, match="hue_high = 200; expected 0 to 179"):
        ColourRange(hue_high=200)


def test_saved_and_loaded(tmp_path):
    """A settings file gives back the same settings."""
    settings = TrackerSettings(ColourRange(40, 80, 60, 20), marker_radius_px=9.5, head="right", edge_px=5)
    save_settings(settings, tmp_path / "markers.yaml")
    assert load_settings(tmp_path / "markers.yaml") == settings


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("/**: {ros__parameters: {hue_lo: 3}}", "'hue_lo', which is not known; did you mean 'hue_low'"),
        ("/**: {ros__parameters: {head: north}}", "expected auto, left, right"),
        ("/**: {ros__parameters: {hue_low: abc}}", "wrong kind"),
        ("just text", "not a ROS 2 parameter file"),
    ],
)
def test_wrong_files_are_explained(tmp_path, text, message):
    """Unknown names, impossible values and other files are each explained."""
    path = tmp_path / "markers.yaml"
    path.write_text(text)
    with pytest.raises(TrackerError, match=message):
        load_settings(path)


def test_impossible_sizes_are_refused():
    """Contradicting sizes are named with what is expected."""
    with pytest.raises(TrackerError, match="0 < smallest < largest"):
        settings_from({"smallest_radius_px": 70.0})
    with pytest.raises(TrackerError, match="expected at least 2 px each"):
        settings_from({"edge_px": 1})
