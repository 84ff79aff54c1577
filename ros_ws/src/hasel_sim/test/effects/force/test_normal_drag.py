# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Normal drag."""

import numpy as np
import pytest
from hasel_sim.model.sections import FLUIDS

DEPTH = 0.05


def test_the_inverse_amplitude_grows_linearly(cantilever, extremes):
    """Energy lost per cycle to pressure goes with amplitude cubed, so 1/amplitude grows by (8/3) b / m each cycle."""
    beam, coefficient = cantilever(), 4.0
    _, tip = beam.ring_down(2.0, "normal_drag", coefficient=coefficient, tip=0.008)
    growth = np.diff(1 / extremes(tip))
    mass = beam.density * beam.height * beam.along(lambda mode: mode**2)
    drag = 0.5 * FLUIDS["canola_oil"][0] * coefficient * beam.along(lambda mode: np.abs(mode) ** 3)
    assert np.mean(growth) == pytest.approx(4 / 3 * drag / mass, rel=0.05)
    assert np.std(growth) < 0.1 * np.mean(growth)


def test_the_inverse_root_of_the_amplitude_grows_linearly_in_the_boundary_layer(cantilever, extremes):
    """A force with the power 3/2 of the velocity takes 1/sqrt(amplitude) up by the same in each cycle."""
    beam, layer = cantilever(), 8.0
    _, tip = beam.ring_down(2.0, "normal_drag", boundary_layer=layer, tip=0.008)
    growth = np.diff(1 / np.sqrt(extremes(tip)))
    density, viscosity = FLUIDS["canola_oil"]
    drag = 0.5 * density * layer * np.sqrt(viscosity / density / DEPTH)
    mass = beam.density * beam.height * beam.along(lambda mode: mode**2)
    cycle = np.linspace(0.0, 2 * np.pi, 4001)
    mean = np.trapezoid(np.abs(np.sin(cycle)) ** 2.5, cycle)
    omega = beam.frequency
    lost = drag * mean * np.sqrt(omega) / omega * beam.along(lambda mode: np.abs(mode) ** 2.5)
    assert np.mean(growth) == pytest.approx(0.25 * lost / mass, rel=0.05)
