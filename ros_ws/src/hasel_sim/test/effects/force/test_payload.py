# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Payload."""

import numpy as np
import pytest


def test_the_frequency_falls_as_rayleigh_says(cantilever, damped_sine):
    """A tip mass on a beam that counts with 33/140 of its own: f falls by sqrt(m / (m + m_p))."""
    beam = cantilever(height=0.01)
    own = 33 / 140 * beam.density * beam.height * beam.length
    mass = 0.5 * own
    plain, _ = damped_sine(*beam.ring_down(2.0), beam.frequency)
    loaded, _ = damped_sine(*beam.ring_down(2.0, "payload", mass=mass), 0.8 * beam.frequency)
    assert loaded / plain == pytest.approx(np.sqrt(own / (own + mass)), rel=0.015)


def test_it_weighs_on_the_tip(cantilever, equilibrium_of):
    """Its weight adds m_p g L^3 / (3 E I) to the sag."""
    beam, gravity, mass = cantilever(height=0.005), 0.02, 0.2
    sag = []
    for carried in (0.0, mass):
        displacement, mesh = equilibrium_of(
            beam.model("payload", mesh_density=2, gravity=gravity, mass=carried)
        )
        sag.append(displacement[mesh.nodes[:, 0] > beam.length - 1e-9, 1].mean())
    assert sag[0] - sag[1] == pytest.approx(
        mass * gravity * beam.length**3 / (3 * beam.bending_stiffness), rel=0.015
    )
