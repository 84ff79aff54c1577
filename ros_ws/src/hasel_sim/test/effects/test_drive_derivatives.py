# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Derivatives by the parameters of effects on the drive, on the grid of a simulation."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import DriveEffect
from hasel_sim.effects.registry import catalogue

DRIVE_EFFECTS = [effect for effect in catalogue().values() if isinstance(effect, DriveEffect)]
HALF_PERIOD_S = 0.25
STEPS_PER_SECOND = 240


@pytest.fixture
def series(contraction_of):
    """Contraction [n, 2] of two periods at the middle of three voltages, for an effect and its values."""
    drive = np.array([[4500.0, 0.0], [0.0, 4500.0], [4500.0, 0.0], [0.0, 4500.0]])
    schedule = DriveSchedule(HALF_PERIOD_S * np.arange(4), drive)
    times = np.arange(0.0, 4 * HALF_PERIOD_S, 1 / STEPS_PER_SECOND)
    return lambda effect, values: contraction_of(schedule, times, effect.id, **values)


def _typical(effect) -> dict[str, float]:
    return {p.name: p.scan[len(p.scan) // 2] if p.scan else p.typical for p in effect.parameters}


@pytest.mark.parametrize("effect", DRIVE_EFFECTS, ids=lambda effect: effect.id)
def test_they_add_up_to_the_change(effect, series):
    """Over a twentieth of the typical size, by Simpson's rule: a staircase, flat to small steps, does not."""
    typical = _typical(effect)
    for p in effect.parameters:

        def at(value: float, name: str = p.name) -> np.ndarray:
            return series(effect, typical | {name: value})

        def slope(value: float, step: float = p.step, at=at) -> np.ndarray:
            return (at(value + step) - at(value - step)) / (2 * step)

        sizes = typical[p.name] * np.linspace(0.2, 1.0, 17)
        wrong = []
        for low, high in zip(sizes[:-1], sizes[1:], strict=True):
            summed = (slope(low) + 4 * slope(0.5 * (low + high)) + slope(high)) * (high - low) / 6
            change = at(high) - at(low)
            wrong.append(np.linalg.norm(summed - change) / np.linalg.norm(change))
        assert np.median(wrong) < 0.1, p.name


@pytest.mark.parametrize("effect", DRIVE_EFFECTS, ids=lambda effect: effect.id)
def test_a_hardly_noticeable_amount_changes_hardly_anything(effect, series):
    """One difference step above nothing, what lags does not lag by a step of the simulation."""
    for p in effect.parameters:
        if p.scan:
            continue
        values = _typical(effect) | {p.name: p.null}
        least = np.abs(series(effect, values | {p.name: p.null + p.step}) - series(effect, values)).max()
        typical = np.abs(series(effect, values | {p.name: p.typical}) - series(effect, values)).max()
        assert least <= 1e-3 * typical, p.name
