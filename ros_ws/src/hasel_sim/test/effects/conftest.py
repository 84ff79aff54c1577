# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A coarse swimmer, a clamped beam, and what one measures on them."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.drive.chain import DriveChain
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.dynamics.statics import equilibrium
from hasel_sim.effects.base import EffectParameter, ForceEffect
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.mechanics.state import DriveState
from hasel_sim.model import Model, load_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from scipy.optimize import least_squares

FLUID, DEPTH = "canola_oil", 0.05
LEVELS = {3500.0: 0.0268, 4500.0: 0.0440, 5500.0: 0.0624}
SLOPE = 0.264


@pytest.fixture(scope="session")
def coarse_swimmer() -> Model:
    """The swimmer with three amplitudes on a coarse mesh, solved far more tightly than finite differences need."""
    amplitudes = {f"amplitude_{level:g}": value for level, value in LEVELS.items()}
    model = load_model("swimmer").with_levels(np.array(list(LEVELS))).in_medium(FLUID, DEPTH)
    return model.with_values({**amplitudes, "slope": SLOPE}).with_numerics(
        mesh_density=0.5, tolerance_m=1e-11, steps_per_second=120
    )


@pytest.fixture(scope="session")
def short_boxes() -> Run:
    """Two quarter-second boxes of 5.5 kV, first on the upper and then on the lower muscle."""
    schedule = DriveSchedule(np.array([0.0, 0.25]), np.array([[5500.0, 0.0], [0.0, 5500.0]]))
    return Run("short boxes", np.arange(0.0, 0.5, 1 / 120), schedule)


@pytest.fixture(scope="session")
def sin_theta_of(short_boxes):
    """sin theta of a model in the short boxes."""
    return lambda model: simulate(model, short_boxes).sin_theta


@pytest.fixture(scope="session")
def coarse_baseline(coarse_swimmer, sin_theta_of) -> np.ndarray:
    """sin theta of the swimmer without effects."""
    return sin_theta_of(coarse_swimmer)


@pytest.fixture(scope="session")
def response():
    """Signal [n, 2] behind one drive effect, for a signal at times [s] and parameter values."""

    def respond(identity: str, time, signal, /, **values) -> np.ndarray:
        effect = catalogue()[identity]
        return effect.respond(time, signal, SimpleNamespace(**{**effect.null(), **values}))

    return respond


@pytest.fixture(scope="session")
def contraction_of():
    """Contraction [n, 2] at times [s] for a schedule, with one drive effect or none."""

    def contraction(schedule: DriveSchedule, times, identity: str | None = None, **values) -> np.ndarray:
        effects = (catalogue()[identity],) if identity else ()
        chain = DriveChain(
            replace(load_model("swimmer").with_levels(np.array(list(LEVELS))), effects=effects)
        )
        baseline = {f"amplitude_{level:g}": value for level, value in LEVELS.items()} | {"slope": SLOPE}
        own = {effect.id: SimpleNamespace(**{**effect.null(), **values}) for effect in effects}
        return chain.contraction(schedule, times, baseline, own)

    return contraction


@pytest.fixture(scope="session")
def derivative():
    """Derivative of an energy [n] by the deformation gradient [n, 2, 2], by central differences."""

    def differentiate(energy, deformation: np.ndarray) -> np.ndarray:
        out = np.empty_like(deformation)
        for i, k in np.ndindex(2, 2):
            step = np.zeros((2, 2))
            step[i, k] = 1e-6
            out[:, i, k] = (energy(deformation + step) - energy(deformation - step)) / 2e-6
        return out

    return differentiate


class _FirstModePull(ForceEffect):
    """A force per mass in proportion to the first mode of a beam."""

    id = "pull"
    depends_on = ()
    parameters = (EffectParameter("acceleration", "a", "m/s^2", 0.0, -1e3, 1e3, 1.0),)

    def __init__(self, beam: "Cantilever") -> None:
        self._beam = beam

    def force(self, at, p: SimpleNamespace) -> np.ndarray:
        """Upwards, most at the tip."""
        return p.acceleration * np.stack(
            [0 * at.reference[:, 0], self._beam.mode(at.reference[:, 0])], axis=1
        )


class Cantilever:
    """A clamped beam without damping of its own, 0.1 m long, with what beam theory says about it."""

    youngs_modulus, poissons_ratio, density = 1e5, 0.3, 1000.0
    wave_number = 1.875104

    def __init__(self, rectangle, length: float = 0.1, height: float = 0.02) -> None:
        self._rectangle, self.length, self.height = rectangle, length, height

    @property
    def bending_stiffness(self) -> float:
        """EI per depth [N m] in plane strain."""
        return self.youngs_modulus / (1 - self.poissons_ratio**2) * self.height**3 / 12

    @property
    def frequency(self) -> float:
        """First angular frequency [rad/s] of a thin beam."""
        inertia = self.density * self.height * self.length**4
        return self.wave_number**2 * np.sqrt(self.bending_stiffness / inertia)

    def mode(self, x: np.ndarray) -> np.ndarray:
        """First mode at x [m], 1 at the tip."""
        z, ratio = self.wave_number * x / self.length, 0.734096
        return (np.cosh(z) - np.cos(z) - ratio * (np.sinh(z) - np.sin(z))) / 2.0

    def along(self, integrand) -> float:
        """Integral over the length of a function of the mode."""
        x = np.linspace(0.0, self.length, 2001)
        return float(np.trapezoid(integrand(self.mode(x)), x))

    def model(
        self,
        identity: str | None = None,
        gravity: float = 0.0,
        retardation: float = 0.0,
        mesh_density: float = 0.5,
        **values,
    ) -> Model:
        """The beam, with one effect or none."""
        beam = self._rectangle(
            length=self.length,
            height=self.height,
            effects=find_effects((identity,)) if identity else (),
            gravity=gravity,
            retardation=retardation,
            values={f"{identity}.{name}": value for name, value in values.items()},
            mesh_density=mesh_density,
        )
        return beam.in_medium(FLUID, DEPTH)

    def bent(self, tip: float) -> np.ndarray:
        """Nodal positions [m] under forces that bend the beam into its first mode; tip: its deflection [m]."""
        pull = _FirstModePull(self)
        values = {"pull.acceleration": tip * self.frequency**2}
        model = self._rectangle(
            length=self.length, height=self.height, effects=(pull,), values=values, mesh_density=0.5
        )
        still = DriveState.single(np.zeros(2), np.zeros(2), 0.0)
        return equilibrium(Builder(model).system(), still, 1.0, 1e-11)[0][..., 0]

    def ring_down(
        self, duration: float, identity: str | None = None, tip: float = 0.004, frames=240.0, **values
    ):
        """Time [s] and tip deflection [m] after letting go of the first mode with a tip deflection [m]."""
        model = self.model(identity, **values).with_numerics(steps_per_second=frames)
        time = np.arange(0.0, duration, 1 / frames)
        run = Run("ring-down", time, None, "held_shape", initial_shape=self.bent(tip))
        return time, simulate(model, run).markers[:, 2, 1]


@pytest.fixture(scope="session")
def cantilever(rectangle):
    """Factory of clamped beams."""
    return lambda **size: Cantilever(rectangle, **size)


@pytest.fixture(scope="session")
def damped_sine():
    """Angular frequency [rad/s] and damping ratio of a ring-down, by least squares."""

    def fit(time: np.ndarray, series: np.ndarray, frequency: float) -> tuple[float, float]:
        def residual(u: np.ndarray) -> np.ndarray:
            mean, cosine, sine, omega, zeta = u
            turn = omega * frequency * time
            shape = np.exp(-zeta * turn) * (cosine * np.cos(turn) + sine * np.sin(turn))
            return (mean + shape) * np.abs(series).max() - series

        found = least_squares(
            residual, [0.0, series[0] / np.abs(series).max(), 0.0, 1.0, 0.01], x_scale="jac"
        ).x
        natural = found[3] * frequency * np.hypot(1.0, found[4])
        return float(natural), float(found[4] / np.hypot(1.0, found[4]))

    return fit


@pytest.fixture(scope="session")
def extremes():
    """Absolute values of the extremes of an oscillation about zero, by a parabola through the largest samples."""

    def find(series: np.ndarray) -> np.ndarray:
        before, here, after = series[:-2], series[1:-1], series[2:]
        turning = np.flatnonzero((here - before) * (after - here) < 0)
        a, b, c = before[turning], here[turning], after[turning]
        return np.abs(b - (c - a) ** 2 / (8 * (a - 2 * b + c)))

    return find
