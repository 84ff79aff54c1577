# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Frequencies of uniform beams against Euler and Bernoulli's."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.dynamics.system import linearise
from hasel_sim.mechanics.state import Memory, Motion
from scipy.linalg import eigh

LENGTH, HEIGHT, MODULUS, DENSITY, RATIO = 0.1, 0.1 / 60, 1e5, 1000.0, 0.3
CLAMPED_FREE = np.array([1.87510407, 4.69409113, 7.85475744])
FREE_FREE = np.array([4.73004074, 7.85320462, 10.9956078])


def _dense(band) -> np.ndarray:
    n, k = band.unknowns, band.half_bandwidth
    out = np.zeros((n, n))
    for row in range(n):
        low, high = max(0, row - k), min(n, row + k + 1)
        out[row, low:high] = band.entries[row, band.diagonal + low - row : band.diagonal + high - row, 0]
    return out[band.held :, band.held :]


def _frequencies(model, still) -> np.ndarray:
    """Circular frequencies [rad/s], ascending, without the rigid motions."""
    system = Builder(model).system()
    nodes = system.nodes[..., None]
    zero = np.zeros_like(nodes)
    line = linearise(system, Motion(nodes, zero, zero), still, Memory())
    stiffness, mass = _dense(line.matrix(1.0, 0.0, 0.0)), _dense(line.matrix(0.0, 0.0, 1.0))
    squares = eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 7])
    return np.sqrt(squares[squares > 1e-3])


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize(("clamped", "roots"), [(True, CLAMPED_FREE), (False, FREE_FREE)])
def test_first_three_frequencies_of_a_slender_beam(plane, clamped, roots, rectangle, still):
    """(beta L)^2 sqrt(E I / rho A) / L^2 within 1 %, clamped and free, in plane strain and plane stress."""
    model = rectangle(LENGTH, HEIGHT, clamped, MODULUS, RATIO, plane=plane)
    modulus = MODULUS / (1 - RATIO**2) if plane == "strain" else MODULUS
    expected = (roots / LENGTH) ** 2 * np.sqrt(modulus * HEIGHT**2 / 12 / DENSITY)
    assert _frequencies(model, still)[:3] == pytest.approx(expected, rel=0.01)
