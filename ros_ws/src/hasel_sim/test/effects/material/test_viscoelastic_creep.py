# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Viscoelastic creep."""

import numpy as np
import pytest
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def test_a_held_load_creeps_as_the_standard_linear_solid(cantilever):
    """Deflection under a constant load: 1 - g/(1+g) exp(-t / ((1+g) tau)) of the one without the Prony term."""
    beam, ratio, time = cantilever(), 0.5, 2.0
    run = Run("loaded", np.array([0.0, 1.5, 3.0, 15.0]), None, "static_equilibrium", 0.0)
    model = beam.model(
        "viscoelastic_creep", 0.05, retardation=0.03, modulus_ratio=ratio, relaxation_time=time
    )
    tip = simulate(model.with_numerics(steps_per_second=120), run).markers[1:, 2, 1]
    final = simulate(beam.model(gravity=0.05), Run("at rest", np.zeros(1))).markers[0, 2, 1]
    expected = 1 - ratio / (1 + ratio) * np.exp(-run.time[1:] / ((1 + ratio) * time))
    assert tip / final == pytest.approx(expected, rel=0.01)


def test_static_equilibrium_is_that_of_the_relaxed_body(cantilever, equilibrium_of):
    """A body that has hung for long carries nothing in its Prony term."""
    beam = cantilever()
    plain, _ = equilibrium_of(beam.model(gravity=0.05))
    creeping, _ = equilibrium_of(beam.model("viscoelastic_creep", gravity=0.05, modulus_ratio=0.8))
    assert creeping == pytest.approx(plain, abs=1e-12)
