# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Structural damping."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue


def _modulus(frequency: np.ndarray, loss_factor: float) -> np.ndarray:
    """Complex modulus of the lasting stiffness and the branches, at frequencies [Hz]."""
    effect, p = catalogue()["structural_damping"], SimpleNamespace(loss_factor=loss_factor)
    constants = SimpleNamespace(equilibrium=np.ones(1), retardation=np.zeros(1))
    effect.modify(constants, p)
    turn = 2j * np.pi * frequency[:, None]
    ratio, time = np.array(effect.branches(p)).T
    lasting = constants.equilibrium[0] + turn[:, 0] * constants.retardation[0]
    return lasting + (ratio * turn * time / (1 + turn * time)).sum(axis=1)


@pytest.mark.parametrize("loss_factor", [0.05, 0.2, 0.5])
def test_the_loss_factor_is_constant_from_a_fifth_to_twenty_hertz(loss_factor):
    """Loss over storage modulus stays within 4 % of eta over two decades, and the storage modulus is 1 at 2 Hz."""
    modulus = _modulus(np.geomspace(0.2, 20.0, 60), loss_factor)
    assert modulus.imag / modulus.real == pytest.approx(loss_factor, rel=0.04)
    assert _modulus(np.array([2.0]), loss_factor).real == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("height", "length", "frames"), [(0.01, 0.1, 240.0), (0.02, 0.1, 240.0), (0.02, 0.06, 960.0)]
)
def test_the_logarithmic_decrement_is_the_same_at_every_frequency(
    height, length, frames, cantilever, damped_sine
):
    """Beams of 1.7, 3.3 and 9 Hz lose the same share per cycle: decrement pi eta, that of a spring-pot.

    A free oscillation s^2 = -s^p of a spring-pot with p = 2/pi atan(eta) has zeta = -cos(pi / (2 - p)).
    """
    beam, eta = cantilever(height=height, length=length), 0.1
    duration = 8 * 2 * np.pi / beam.frequency
    time, tip = beam.ring_down(duration, "structural_damping", frames=frames, loss_factor=eta)
    after = time > duration / 4
    _, zeta = damped_sine(time[after], tip[after], beam.frequency)
    power = 2 / np.pi * np.arctan(eta)
    assert zeta == pytest.approx(-np.cos(np.pi / (2 - power)), rel=0.03)
    assert 2 * np.pi * zeta == pytest.approx(np.pi * eta, rel=0.05)
