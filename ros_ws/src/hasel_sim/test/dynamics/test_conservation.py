# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a free body must keep, and how much a time step may lose."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.dynamics.generalised_alpha import step_coefficients
from hasel_sim.dynamics.integrator import Stepper
from hasel_sim.dynamics.system import linearise
from hasel_sim.mechanics.state import DriveState, Memory, Motion, State
from scipy.linalg import eigh

NONE = np.zeros(2)


def _dense(band) -> np.ndarray:
    n, k = band.unknowns, band.half_bandwidth
    out = np.zeros((n, n))
    for row in range(n):
        low, high = max(0, row - k), min(n, row + k + 1)
        out[row, low:high] = band.entries[row, band.diagonal + low - row : band.diagonal + high - row, 0]
    return out[band.held :, band.held :]


def _bending_mode(system, still) -> tuple[np.ndarray, float]:
    """First bending mode [nodes, 2, 1] of a free body and its frequency [Hz]."""
    nodes = system.nodes[..., None]
    zero = np.zeros_like(nodes)
    line = linearise(system, Motion(nodes, zero, zero), still, Memory())
    stiffness, mass = _dense(line.matrix(1.0, 0.0, 0.0)), _dense(line.matrix(0.0, 0.0, 1.0))
    squares, modes = eigh(stiffness, mass, subset_by_index=[3, 3])
    return modes[:, 0].reshape(-1, 2, 1), np.sqrt(squares[0]) / (2 * np.pi)


def _elastic_energy(system, position, shear, lame) -> float:
    """Integral of mu/2 (I1 - 2 - 2 ln J) + lambda/2 (ln J)^2 per metre of depth."""
    a, b, c, d = np.moveaxis(system.solid.gradient(position)[..., 0], -1, 0)
    log_volume = np.log(a * d - b * c)
    density = 0.5 * shear * (a**2 + b**2 + c**2 + d**2 - 2 - 2 * log_volume) + 0.5 * lame * log_volume**2
    return float((density * system.solid.areas).sum())


def _kinetic_energy(system, velocity) -> float:
    return 0.5 * float((velocity * system.mass.product(velocity[None])[0]).sum())


def _swing(model, still, rate, periods):
    """Energies [steps + 1], bending displacement [steps + 1] and period [s] of a body set swinging in its mode."""
    system = Builder(model).system()
    mode, frequency = _bending_mode(system, still)
    speed = 2 * np.pi * frequency * 0.01 / np.ptp(mode[:, 1])
    state = State(system.nodes[..., None].copy(), speed * mode, np.zeros_like(mode))
    stepper, c = Stepper(system, 1e-11), step_coefficients(1 / rate, 0.9)
    weight = system.mass.product(mode[None])[0]
    shear, lame = system.solid.shear[0, 0], system.solid.linear_lame[0, 0]
    energies, bends = [], []
    for _ in range(round(periods / frequency * rate) + 1):
        elastic = _elastic_energy(system, state.position, shear, lame)
        energies.append(elastic + _kinetic_energy(system, state.velocity))
        bends.append((weight * (state.position - system.nodes[..., None])).sum())
        state = stepper.follow(state, still, c)[-1].after
    return np.array(energies), np.array(bends), 1 / frequency


def test_energy_of_an_undamped_free_body_is_constant(rectangle, still):
    """Elastic plus kinetic energy within 0.1 % over 10 periods at 480 Hz."""
    model = rectangle(0.16, 0.008, clamped=False, youngs_modulus=2e4, poissons_ratio=0.45)
    energies, _, period = _swing(model, still, 480, 10)
    assert 1.0 < 1 / period < 5.0
    assert np.abs(energies / energies[0] - 1).max() < 1e-3


def test_bending_keeps_its_amplitude_at_one_step_a_frame(rectangle, still):
    """Less than 1 % of the amplitude lost per cycle at 120 Hz."""
    model = rectangle(0.16, 0.008, clamped=False, youngs_modulus=2e4, poissons_ratio=0.45)
    energies, bends, period = _swing(model, still, 120, 6)
    cycle = round(120 * period)
    first, last = np.abs(bends[:cycle]).max(), np.abs(bends[-cycle:]).max()
    assert (last / first) ** (1 / 5) > 0.99
    assert (energies[-1] / energies[0]) ** (0.5 / 6) > 0.99


def _momenta(system, state) -> tuple[np.ndarray, float, float, float]:
    """Linear and angular momentum, and the sums of their magnitudes over the nodes."""
    momentum = system.mass.product(state.velocity[None])[0, ..., 0]
    x, y = (state.position - state.position.mean(axis=0))[..., 0].T
    moments = x * momentum[:, 1] - y * momentum[:, 0]
    return momentum.sum(axis=0), moments.sum(), np.abs(momentum).sum(), np.abs(moments).sum()


@pytest.mark.parametrize(("rho", "allowed"), [(1.0, 1e-6), (0.9, 1e-3)])
def test_momentum_of_the_free_swimmer_is_conserved(rho, allowed, swimmer):
    """Muscles move no centre of mass and spin no body up; exactly with rho = 1, nearly with the default."""
    system = Builder(swimmer).system()
    stepper, c = Stepper(system, 1e-12), step_coefficients(1 / 240, rho)
    zero = np.zeros((*system.nodes.shape, 1))
    state = State(system.nodes[..., None].copy(), zero, zero.copy())
    linear, angular, flow, spin = [], [], [], []
    for step in range(120):
        upper = 0.06 * min(1.0, step / 30)
        drive = DriveState.single(NONE, np.array([upper, 0.0]), (step + 0.5) / 240)
        state = stepper.follow(state, drive, c)[-1].after
        for kept, value in zip((linear, angular, flow, spin), _momenta(system, state), strict=True):
            kept.append(value)
    assert np.abs(linear).max() < 1e-8 * max(flow)
    assert np.abs(angular).max() < allowed * max(spin)
