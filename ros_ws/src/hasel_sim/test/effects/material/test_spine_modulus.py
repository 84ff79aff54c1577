# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Spine modulus."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.dynamics.system import linearise
from hasel_sim.mechanics.state import Memory, Motion


def _bending_energy(model, still, curvature: float) -> float:
    """Energy per depth [N] of the whole body bent to a curvature [1/m], without stress across it, to second order."""
    builder = Builder(model)
    system, (x, y) = builder.system(), builder.mesh.nodes.T
    poisson = 0.45 / 0.55
    shift = curvature * np.stack([-x * y, 0.5 * x**2 + 0.5 * poisson * y**2], axis=1)[None, ..., None]
    rest = Motion(builder.mesh.nodes[..., None], 0 * shift[0], 0 * shift[0])
    force = linearise(system, rest, still, Memory()).along(shift, 0 * shift, 0 * shift)
    return 0.5 * float(np.sum(force * shift))


def test_the_spine_alone_gains_bending_stiffness(coarse_swimmer, still):
    """Doubling it adds E h^3 / (12 (1 - nu^2)) over the whole spine, nose to fin, and nothing else."""
    model, curvature = coarse_swimmer.with_effects("spine_modulus"), 0.7
    single, double = (
        _bending_energy(model.with_values({"spine_modulus.scale": scale}), still, curvature)
        for scale in (1.0, 2.0)
    )
    stiffness = 130e3 / (1 - 0.45**2) * 0.001**3 / 12
    assert double - single == pytest.approx(0.5 * stiffness * curvature**2 * 0.19, rel=1e-6)
