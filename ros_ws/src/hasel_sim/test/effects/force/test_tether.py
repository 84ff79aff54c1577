# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Tether."""

import pytest


def test_a_spring_at_the_tip_shares_the_load(cantilever, equilibrium_of):
    """A beam under its weight sags by 1 / (1 + k L^3 / (3 E I)) of what it would without the spring."""
    beam = cantilever(height=0.005)
    stiffness = 3 * beam.bending_stiffness / beam.length**3
    sag = []
    for values in ({"stiffness": 0.0}, {"stiffness": stiffness}):
        displacement, mesh = equilibrium_of(
            beam.model("tether", mesh_density=2, gravity=0.01, position=beam.length, **values)
        )
        sag.append(displacement[mesh.nodes[:, 0] > beam.length - 1e-9, 1].mean())
    assert sag[1] / sag[0] == pytest.approx(0.5, rel=0.01)
