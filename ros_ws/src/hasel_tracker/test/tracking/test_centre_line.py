# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The centre line of shapes whose middle is known."""

import cv2
import numpy as np
import pytest
from hasel_tracker.tracking.centre_line import centre_line
from hasel_tracker.tracking.silhouette import find_silhouette

RADIUS, HALF_WIDTH, TURN = 300.0, 14.0, 1.2
CENTRE = np.array([320.0, 420.0])


def arc_picture(noise: float, seed: int = 0) -> np.ndarray:
    """A band about an arc of a circle, square at both ends, dark on light ground, with smooth edges."""
    y, x = np.mgrid[0:480, 0:640].astype(float)
    away = np.hypot(x - CENTRE[0], y - CENTRE[1])
    angle = np.arctan2(x - CENTRE[0], CENTRE[1] - y)
    inside = np.minimum(HALF_WIDTH - np.abs(away - RADIUS), (TURN / 2 - np.abs(angle)) * RADIUS)
    light = 190.0 - 120.0 * np.clip(inside + 0.5, 0.0, 1.0)
    light = cv2.GaussianBlur(light, (0, 0), 0.8) + np.random.default_rng(seed).normal(0.0, noise, light.shape)
    return cv2.cvtColor(np.clip(np.rint(light), 0, 255).astype(np.uint8), cv2.COLOR_GRAY2BGR)


def test_arc_of_a_circle_comes_back():
    """Length, width and every place along an arc of a circle are right to a few tenths of a pixel."""
    line = centre_line(find_silhouette(arc_picture(0.0)).silhouette)
    assert line.length_px == pytest.approx(RADIUS * TURN, abs=0.6)
    assert line.half_width_px[20:-20] == pytest.approx(np.full(56, HALF_WIDTH), abs=0.2)
    shares = np.linspace(0.02, 0.98, 25)
    angle = (shares - 0.5) * TURN
    true = CENTRE + RADIUS * np.column_stack([np.sin(angle), -np.cos(angle)])
    found = line.at(shares)
    found = found if found[0, 0] < found[-1, 0] else found[::-1]
    assert np.linalg.norm(found - true, axis=1).max() < 0.5
    assert np.abs(np.linalg.norm(found - CENTRE, axis=1) - RADIUS).max() < 0.1


def test_the_standard_deviation_is_that_of_repeated_pictures():
    """Across the line, places scatter from picture to picture by the σ said, within a factor of two."""
    shares = np.array([0.1, 0.5, 0.9])
    away, said = [], []
    for seed in range(12):
        line = centre_line(find_silhouette(arc_picture(8.0, seed)).silhouette)
        away.append(np.linalg.norm(line.at(shares) - CENTRE, axis=1))
        away[-1] = away[-1] if line.at([0.0])[0, 0] < CENTRE[0] else away[-1][::-1]
        said.append(line.sigma_at(shares))
    scatter = np.sqrt(np.mean(np.var(away, axis=0, ddof=1)))
    assert scatter / 2 < np.mean(said) < 2 * scatter


def test_a_disc_has_no_centre_line():
    """What is not slender is no swimmer."""
    image = cv2.circle(np.full((240, 320, 3), 190, np.uint8), (160, 120), 40, (60, 60, 60), -1, cv2.LINE_AA)
    assert centre_line(find_silhouette(image).silhouette) is None


def test_uneven_light_is_no_body_and_hides_none():
    """A ground whose light falls to half is empty; a body on it is found where the light is low as well."""
    fall = np.linspace(200.0, 100.0, 640)[None, :].repeat(360, axis=0)
    image = cv2.cvtColor(np.rint(fall).astype(np.uint8), cv2.COLOR_GRAY2BGR)
    assert find_silhouette(image).note == "no body stands out from the ground"
    cv2.rectangle(image, (150, 170), (560, 190), (30, 30, 30), -1)
    line = centre_line(find_silhouette(image).silhouette)
    assert line.length_px == pytest.approx(411.0, abs=1.0)
    assert line.at([0.5])[0] == pytest.approx([355.0, 180.0], abs=0.8)
    assert line.at([0.5])[0, 1] == pytest.approx(180.0, abs=0.05)
