# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import cv2
import numpy as np
import pytest
from hasel_tracker.tracking.marker_finder import nearest_outline
from hasel_tracker.tracking.marker_moment import measure_marker
from hasel_tracker.tracking.tracker_settings import ColourRange

MARKER = np.array([168.0, 72.0, 22.0])
WATER = np.array([198.0, 196.0, 188.0])
SIZE, FINE = 80, 8
POSITIONS = np.random.default_rng(3).uniform(36.0, 44.0, (12, 2))


def disc(centre: np.ndarray, background: np.ndarray, radius: float = 12.0) -> np.ndarray:
    """A blurred disc drawn by brute supersampling; background (80, 80, 3) or a colour."""
    axis = (np.arange(SIZE * FINE) + 0.5) / FINE - 0.5
    inside = np.hypot(axis[None, :] - centre[0], axis[:, None] - centre[1]) < radius
    share = inside.reshape(SIZE, FINE, SIZE, FINE).mean(axis=(1, 3))[..., None]
    return cv2.GaussianBlur((1.0 - share) * background + share * MARKER, (0, 0), 0.8)


def measured(picture: np.ndarray, near: np.ndarray) -> np.ndarray:
    """Centre found in a picture (float BGR), or NaN."""
    image = np.clip(np.rint(picture), 0, 255).astype(np.uint8)
    outline = nearest_outline(ColourRange().mask(image), near, 450.0)
    found = measure_marker(image, outline.contour, 3)
    return np.full(2, np.nan) if found is None else found.centre


def rms(errors: list[np.ndarray]) -> float:
    """Root mean square distance."""
    return float(np.sqrt((np.array(errors) ** 2).sum(axis=1).mean()))


def test_clean_disc_to_a_few_thousandths_of_a_pixel():
    """On even ground the centre is right to 0.005 px wherever it lies between the pixels."""
    assert rms([measured(disc(p, WATER), p) - p for p in POSITIONS]) < 0.005


def test_slanting_light_does_not_pull():
    """Light that falls by a third across the region moves the centre by less than 0.02 px."""
    light = np.linspace(1.15, 0.85, SIZE)[None, :, None]
    errors = [measured(disc(p, WATER) * light, p) - p for p in POSITIONS]
    assert rms(errors) < 0.02


def test_line_ending_under_the_marker_does_not_pull():
    """A dark spine that ends under the marker moves the centre by less than 0.03 px; a plain moment by over 0.3."""
    errors, plain = [], []
    for position in POSITIONS:
        background = np.tile(WATER, (SIZE, SIZE, 1))
        row = round(position[1])
        background[row - 3 : row + 3, : int(position[0])] = 110.0
        picture = disc(position, background)
        errors.append(measured(picture, position) - position)
        weight = np.maximum(WATER.mean() - picture.mean(axis=2), 0.0)
        weight[np.hypot(*(np.indices((SIZE, SIZE))[::-1] - position[:, None, None])) > 18.0] = 0.0
        rows, columns = np.indices(weight.shape)
        plain.append([(weight * columns).sum(), (weight * rows).sum()] / weight.sum() - position)
    assert rms(errors) < 0.03
    assert rms(plain) > 0.3


def test_highlight_on_the_marker_does_not_pull():
    """A white reflection within the marker changes nothing."""
    errors = []
    for position in POSITIONS:
        picture = disc(position, WATER)
        cv2.circle(
            picture, (int(position[0]) + 4, int(position[1]) - 3), 2, (255.0, 255.0, 255.0), cv2.FILLED
        )
        errors.append(measured(picture, position) - position)
    assert rms(errors) < 0.01


def test_textured_ground_is_left_to_colour():
    """Over coarse grey texture, where luma would fail, colour still places the marker to 0.1 px."""
    random = np.random.default_rng(5)
    errors = []
    for position in POSITIONS:
        texture = cv2.GaussianBlur(random.normal(0.0, 1.0, (SIZE, SIZE)), (0, 0), 4.0)
        grey = np.clip(130.0 + 60.0 * texture / texture.std(), 20.0, 240.0)
        errors.append(measured(disc(position, np.repeat(grey[..., None], 3, axis=2)), position) - position)
    assert rms(errors) < 0.1


def test_noise_enters_as_theory_says():
    """White noise moves the centre by no more than three times what the marker's edge band lets through.

    The band has about 2 π r · 2 e pixels at distance r; each adds noise/contrast · r to a moment of area π r².
    """
    random = np.random.default_rng(7)
    noise, radius, edge = 4.0, 12.0, 3.0
    position = np.array([40.2, 39.7])
    clean = disc(position, WATER)
    found = [measured(clean + random.normal(0.0, noise, clean.shape), position) for _ in range(80)]
    contrast = float((WATER - MARKER) @ [0.114, 0.587, 0.299])
    luma_noise = noise * np.linalg.norm([0.114, 0.587, 0.299])
    pixels = 2.0 * np.pi * radius * 2.0 * edge
    expected = luma_noise / contrast * np.sqrt(0.5 * pixels) * radius / (np.pi * radius**2)
    spread = np.std(found, axis=0).mean()
    assert 0.5 * expected < spread < 3.0 * expected


def test_marker_cut_by_the_region_is_not_measured():
    """A marker whose surroundings are not all in view gives nothing rather than something wrong."""
    assert np.isnan(measured(disc(np.array([10.0, 40.0]), WATER), np.array([10.0, 40.0]))).all()


@pytest.mark.parametrize("radius", [6.0, 20.0])
def test_other_marker_sizes(radius):
    """Small and large markers are measured as well."""
    position = np.array([40.3, 39.6])
    image = np.rint(disc(position, WATER, radius)).astype(np.uint8)
    outline = nearest_outline(ColourRange().mask(image), position, np.pi * radius**2)
    found = measure_marker(image, outline.contour, 3)
    assert np.linalg.norm(found.centre - position) < 0.01
    assert found.area == pytest.approx(np.pi * radius**2, rel=0.02)
