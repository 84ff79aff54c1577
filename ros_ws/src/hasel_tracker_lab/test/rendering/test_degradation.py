import numpy as np
import pytest
from hasel_tracker_lab.rendering.degradation import add_glints, add_noise, compress, uneven_light

GREY = np.full((240, 320, 3), 120, np.uint8)


def test_noise_has_its_standard_deviation_and_differs_between_frames():
    """Noise of 4 grey levels is that, has no offset, and two frames have nothing in common."""
    first, second = (add_noise(GREY, 4.0, index, 1).astype(float) - 120.0 for index in (0, 1))
    assert first.std() == pytest.approx(4.0, rel=0.03)
    assert abs(first.mean()) < 0.05
    assert abs(np.corrcoef(first.ravel(), second.ravel())[0, 1]) < 0.02


def test_light_falls_across_the_picture():
    """The far corner gets the share of light that is left."""
    picture = uneven_light(GREY.astype(np.float32), 0.6)
    assert picture[0, 0, 0] == pytest.approx(120.0, rel=0.05)
    assert picture[-1, -1, 0] == pytest.approx(0.4 * 120.0, rel=0.05)


def test_glints_are_few_and_bright():
    """Reflections brighten a small part of the picture and wander with time."""
    now, later = (add_glints(GREY.astype(np.float32), 5, time_s, 3) for time_s in (0.0, 0.5))
    assert 1e-4 < (now > 150).mean() < 0.2
    assert np.abs(now - later).max() > 10.0


def test_compression_stores_colour_at_half_resolution():
    """Through JPEG, fine stripes of colour vanish while fine stripes of brightness stay."""
    colour, luma = GREY.copy(), GREY.copy()
    colour[:, ::2] = (200, 90, 60)  # nearly the luma of (33, 111, 128)
    colour[:, 1::2] = (33, 111, 128)
    luma[:, ::2] = 180
    contrast = [np.abs(np.diff(compress(each, 95).astype(float), axis=1)).mean() for each in (colour, luma)]
    assert contrast[0] < 0.25 * contrast[1]
