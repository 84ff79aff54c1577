# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Initial relaxation."""

import numpy as np
import pytest
from hasel_sim.run import Run
from hasel_sim.simulate import simulate, simulate_many


def test_the_sag_grows_as_the_starting_stress_relaxes(cantilever):
    """Under its weight the body is held up by the share g of its stress: sag (1 - g exp(-t / tau))."""
    beam, share, time = cantilever(), 0.2, 2.0
    run = Run("held up", np.array([0.0, 1.5, 3.0, 15.0]), None, "static_equilibrium", 1.0)
    values = {"share": share, "relaxation_time": time}
    model = beam.model("initial_relaxation", 0.05, retardation=0.03, **values)
    tip = simulate(model.with_numerics(steps_per_second=120), run).markers[:, 2, 1]
    assert tip[1:] / tip[0] == pytest.approx(1 - share * np.exp(-run.time[1:] / time), rel=0.005)


def test_the_frequency_is_that_without_it(cantilever, damped_sine):
    """What relaxes is stress of the start only: it is not stiffer for a swing, as with a Prony term."""
    beam = cantilever()
    plain, _ = damped_sine(*beam.ring_down(1.0), beam.frequency)
    time, tip = beam.ring_down(1.0, "initial_relaxation", share=0.2, relaxation_time=0.05)
    relaxing, _ = damped_sine(time[72:], tip[72:], beam.frequency)
    assert relaxing == pytest.approx(plain, rel=1e-3)


def test_derivatives_hold_what_the_start_stress_changes(cantilever):
    """By its own numbers, stiffness and rest shape, where the first instant has a stress: those of differences."""
    model = cantilever().model("initial_relaxation", 0.05, retardation=0.01, share=0.15, relaxation_time=0.3)
    model = model.with_effects("soft_modulus", "pre_bend").with_values({"pre_bend.curvature": 0.5})
    model = model.with_numerics(steps_per_second=120, tolerance_m=1e-13)
    names = [
        "initial_relaxation.share",
        "initial_relaxation.relaxation_time",
        "soft_modulus.scale",
        "pre_bend.curvature",
    ]
    runs = [
        Run("let go", np.arange(0.0, 0.4, 1 / 60), None, "static_equilibrium", factor)
        for factor in (1.4, 0.7)
    ]
    found = simulate_many([(model, run) for run in runs], names)
    for run, beside in zip(runs, found, strict=True):
        slopes = simulate(model, run, names).slopes
        assert beside.slopes == pytest.approx(slopes, abs=1e-9)
        for column, name in enumerate(names):
            step = 1e-4
            ends = [
                simulate(model.with_values({name: model.values[name] + sign * step}), run).sin_theta
                for sign in (1, -1)
            ]
            expected = (ends[0] - ends[1]) / (2 * step)
            assert slopes[:, column] == pytest.approx(expected, abs=1e-5 * np.abs(expected).max()), name
