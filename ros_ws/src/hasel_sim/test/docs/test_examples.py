# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The documented examples do what they say."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from hasel_sim.mesh.body_mesh import half_height

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"


@pytest.fixture
def example(monkeypatch):
    """Loads an example as a module."""

    def load(name: str):
        specification = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
        module = importlib.util.module_from_spec(specification)
        monkeypatch.setitem(importlib.import_module("sys").modules, name, module)
        specification.loader.exec_module(module)
        return module

    return load


def test_the_best_waveform_alternates_and_swings_at_least_as_far_as_the_box(example):
    """From pulses at the wrong time, twice the swing; the muscles end up half a period apart."""
    best = example("optimise_waveform").optimise(3.5)
    assert best.angle_after > 1.8 * best.angle_before
    assert best.angle_after >= best.angle_box
    upper, upper_for, lower, lower_for = best.switching
    assert (lower + lower_for / 2) - (upper + upper_for / 2) == pytest.approx(0.5, abs=0.1)
    assert "rises from" in str(best)


def test_the_best_outline_bends_more_with_the_same_area(example):
    """Ten per cent more, nowhere higher than before, nowhere thinner than allowed."""
    module = example("optimise_outline")
    best = module.optimise(iterations=8)
    assert best.angle_after > 1.1 * best.angle_before
    start = np.array([0.3, 5.13847447, -13.84583811, 19.51736782, -18.6011192, 7.61111502])
    s = np.linspace(0, 1, 201)
    before, after = half_height(start, 1.0, s), half_height(best.coefficients, 1.0, s)
    assert np.trapezoid(after, s) == pytest.approx(np.trapezoid(before, s), rel=1e-3)
    assert after.max() < before.max() + 0.01
    assert after.min() > module.LOWEST - 0.01


def test_a_measured_fish_swims_as_fast_as_its_tail_beats(example):
    """Mean error over eight speeds below 0.025 m/s (published: 0.134 for elongated-body theory, 0.019 fitted)."""
    module = example("measured_fish")
    errors = [abs(module.speed(run, 0.43) - run.speed) for run in module.RUNS]
    assert np.mean(errors) < 0.025
    assert max(errors) < 0.05
    ratios = [run.frequency / run.named for run in module.RUNS]
    assert ratios == pytest.approx([0.75] * 8, abs=0.015)


def test_the_drag_of_the_measured_fish_meets_the_runs_it_is_fitted_to(example):
    """Somewhat too much drag makes both too slow, somewhat too little too fast."""
    module = example("measured_fish")
    chosen = [run for run in module.RUNS if run.named in module.FITTED]
    slow, fast = (sum(module.speed(run, drag) - run.speed for run in chosen) for drag in (0.47, 0.39))
    assert slow < 0 < fast
