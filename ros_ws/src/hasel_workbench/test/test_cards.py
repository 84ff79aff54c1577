# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The scale over which a value is dragged."""

import math

import pytest
from hasel_sim.model import load_model
from hasel_workbench.cards import Slider, sliders

PIXELS = 140


def value_at(slider: Slider, share: float) -> float:
    """As tuning.js has it."""
    first, last = (math.asinh((end - slider.centre) / slider.size) for end in (slider.lowest, slider.highest))
    return slider.centre + slider.size * math.sinh(first + share * (last - first))


def effect_sliders() -> list[tuple[Slider, float]]:
    """Of every parameter of the model's effects that has a null, with its typical distance from it."""
    effects = (
        "quadratic_drag",
        "payload",
        "camera_latency",
        "soft_modulus",
        "drive_creep",
        "spine_stiffening",
    )
    model = load_model("swimmer").with_effects(*effects)
    sizes = {
        f"{each.id}.{p.name}": abs(p.typical - p.null)
        for each in model.effects
        for p in each.parameters
        if not p.scan
    }
    return [(each, sizes[each.name]) for each in sliders(model) if each.name in sizes]


def test_a_pixel_is_fine_around_the_null_and_the_ends_are_reached():
    """At the typical size a pixel moves the value by less than a fifth of it, on both sides where there are two."""
    found = effect_sliders()
    assert len(found) == 6
    for slider, size in found:
        assert value_at(slider, 0.0) == pytest.approx(slider.lowest, abs=1e-9 * size)
        assert value_at(slider, 1.0) == pytest.approx(slider.highest)
        near = [value_at(slider, n / PIXELS) for n in range(PIXELS + 1)]
        steps = [b - a for a, b in zip(near, near[1:], strict=False) if abs(a - slider.centre) < size]
        assert 0 < max(steps) < size / 5
        assert len(steps) > PIXELS / 15


def test_the_slider_stands_at_its_value():
    """Its share of the way leads back to the value."""
    for slider in sliders(load_model("swimmer").with_effects("quadratic_drag", "drive_creep", "tether")):
        assert value_at(slider, slider.share) == pytest.approx(slider.value, abs=1e-12)
