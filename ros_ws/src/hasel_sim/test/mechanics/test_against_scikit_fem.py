# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The same clamped beam solved by an independent finite-element library, with its own elements and time stepping."""

import numpy as np
import skfem
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, det, dot, grad, inv, mul, trace, transpose

LENGTH, HEIGHT, MODULUS, RATIO, DENSITY = 0.1, 0.02, 6.5e4, 0.3, 1000.0
RETARDATION = 0.004
SHEAR = MODULUS / (2 * (1 + RATIO))
LAME = 2 * SHEAR * RATIO / (1 - 2 * RATIO)
IDENTITY = np.eye(2)[:, :, None, None]


def _first_piola(F, rate):
    inverse = inv(F)
    strain_rate = 0.5 * (mul(transpose(F), rate))
    strain_rate = strain_rate + transpose(strain_rate)
    S = RETARDATION * (LAME * trace(strain_rate) * IDENTITY + 2 * SHEAR * strain_rate)
    back = transpose(inverse)
    elastic = SHEAR * (F - back) + LAME * np.log(det(F)) * back
    return elastic + mul(F, S)


@skfem.BilinearForm
def _mass(u, v, w):
    return DENSITY * dot(u, v)


@skfem.BilinearForm
def _stiffness(u, v, w):
    """Derivative of the elastic force; w["position"] is the deformed shape."""
    F = w["position"].grad
    back = transpose(inv(F))
    change = mul(back, mul(transpose(grad(u)), back))
    volume = ddot(back, grad(u))
    P = SHEAR * (grad(u) + change)
    P = P + LAME * (volume * back - np.log(det(F)) * change)
    return ddot(P, grad(v))


@skfem.LinearForm
def _internal(v, w):
    return ddot(_first_piola(w["position"].grad, w["velocity"].grad), grad(v))


class _Beam:
    """Nine-node elements on a mesh of its own; unknowns are nodal positions."""

    def __init__(self, gravity: float) -> None:
        mesh = skfem.MeshQuad.init_tensor(np.linspace(0, LENGTH, 21), np.linspace(-HEIGHT / 2, HEIGHT / 2, 5))
        self.basis = skfem.Basis(mesh, skfem.ElementVector(skfem.ElementQuad2()), intorder=4)
        where = self.basis.doflocs
        even = np.zeros(where.shape[1], dtype=bool)
        even[self.basis.split_indices()[0]] = True
        self.rest = np.where(even, where[0], where[1])
        self.free = self.basis.complement_dofs(self.basis.get_dofs(lambda x: x[0] < 1e-9))
        self.mass = _mass.assemble(self.basis)
        self.weight = self.mass @ np.where(even, 0.0, -gravity)
        tip = (np.abs(where[0] - LENGTH) < 1e-9) & (np.abs(where[1]) < 1e-9)
        self.tip = np.flatnonzero(tip)

    def residual(self, position, velocity):
        position, velocity = self.basis.interpolate(position), self.basis.interpolate(velocity)
        return _internal.assemble(self.basis, position=position, velocity=velocity) - self.weight

    def stiffness(self, position):
        return _stiffness.assemble(self.basis, position=self.basis.interpolate(position))

    def equilibrium(self):
        position, still = self.rest.copy(), np.zeros_like(self.rest)
        for _ in range(20):
            residual, matrix = self.residual(position, still), self.stiffness(position)
            change = splu(matrix[self.free][:, self.free].tocsc()).solve(residual[self.free])
            position[self.free] -= change
            if np.abs(change).max() < 1e-11:
                return position
        raise AssertionError("the reference found no equilibrium")

    def motion(self, steps, step):
        """Tip positions [steps + 1, 2] from rest by the implicit mid-point rule."""
        position, velocity = self.rest.copy(), np.zeros_like(self.rest)
        tips = [position[self.tip]]
        for number in range(steps):
            if number % 5 == 0:
                matrix = self.mass * (2 / step) + self.stiffness(position) * (step / 2 + RETARDATION)
                solve = splu(matrix[self.free][:, self.free].tocsc()).solve
            middle = velocity.copy()
            for _ in range(50):
                out = self.mass @ (2 * (middle - velocity) / step)
                out += self.residual(position + 0.5 * step * middle, middle)
                change = solve(out[self.free])
                middle[self.free] -= change
                if np.abs(change).max() * step < 1e-8:
                    break
            position, velocity = position + step * middle, 2 * middle - velocity
            tips.append(position[self.tip])
        return np.array(tips)


def test_static_equilibrium_under_gravity(rectangle, equilibrium_of):
    """Tip displacement of a beam hanging far down, within 0.5 %."""
    model = rectangle(LENGTH, HEIGHT, True, MODULUS, RATIO, gravity=9.81)
    displacement, mesh = equilibrium_of(model)
    tip = np.flatnonzero((mesh.nodes[:, 0] > LENGTH - 1e-9) & (np.abs(mesh.nodes[:, 1]) < 1e-9))[0]
    beam = _Beam(9.81)
    expected = (beam.equilibrium() - beam.rest)[beam.tip]
    assert abs(expected[1]) > 0.4 * LENGTH
    assert np.linalg.norm(displacement[tip] - expected) < 0.005 * np.linalg.norm(expected)


def test_motion_under_gravity_from_rest(rectangle):
    """The tail's fall and swing over one period, damped, within 0.2 % of its reach at every frame."""
    model = rectangle(
        LENGTH,
        HEIGHT,
        True,
        MODULUS,
        RATIO,
        RETARDATION,
        gravity=4.0,
        steps_per_second=480.0,
        mesh_density=2.0,
    )
    frames = np.arange(61) / 120
    fall = Run("fall", frames, initial_state="static_equilibrium", initial_load_factor=0.0)
    tail = simulate(model, fall).markers[:, 2]
    expected = _Beam(4.0).motion(240, 1 / 480)[::4]
    reach = np.abs(expected - expected[0]).max()
    assert reach > 0.3 * LENGTH
    assert np.linalg.norm(tail - expected, axis=1).max() < 0.002 * reach
