# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Gravity tilt."""

import numpy as np
import pytest


def test_a_clamped_beam_sags_sideways(cantilever, equilibrium_of):
    """The tip of a beam under the sideways part of its weight deflects by w L^4 / (8 E I)."""
    beam, tilt = cantilever(height=0.005), 0.002
    displacement, mesh = equilibrium_of(beam.model("gravity_tilt", mesh_density=2, tilt=tilt))
    tip = displacement[mesh.nodes[:, 0] > beam.length - 1e-9, 1].mean()
    load = beam.density * beam.height * 9.81 * np.sin(tilt)
    assert tip == pytest.approx(load * beam.length**4 / (8 * beam.bending_stiffness), rel=0.01)


def test_a_free_body_slides_without_bending(coarse_swimmer, coarse_baseline, sin_theta_of):
    """Without friction or tether every part of a free body falls alike, and the angle does not change."""
    model = coarse_swimmer.with_effects("gravity_tilt").with_values({"gravity_tilt.tilt": 0.05})
    assert sin_theta_of(model) == pytest.approx(coarse_baseline, abs=4e-6)
