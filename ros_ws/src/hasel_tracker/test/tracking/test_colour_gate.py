import colorsys

import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.colour_gate import ColourRange


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
