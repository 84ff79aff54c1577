# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Bodies, effects and runs small enough to check against theory."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.dynamics.statics import equilibrium
from hasel_sim.effects.base import EffectParameter, ForceEffect
from hasel_sim.mechanics.state import DriveState
from hasel_sim.model import Model, Parameter, load_model
from hasel_sim.model.description import Description
from hasel_sim.run import Run
from threadpoolctl import threadpool_limits


class TipForce(ForceEffect):
    """A constant force on the tail marker."""

    id = "tip_force"
    physics = "Something pushes the tail."
    equation = "f = (0, F)"
    sites = "points"
    depends_on = ("position",)
    parameters = (EffectParameter("force", "F", "N/m", 0.0, -1e3, 1e3, 1.0),)

    def points(self, markers, p: SimpleNamespace):
        """Only the tail."""
        return markers[2:]

    def force(self, at, p: SimpleNamespace):
        """Across the body as it was at rest."""
        return np.broadcast_to([0.0, 1.0], at.position.shape) * p.force


@pytest.fixture(scope="session", autouse=True)
def _one_thread():
    """Small matrices do not profit from more."""
    with threadpool_limits(1):
        yield


@pytest.fixture(scope="session")
def still() -> DriveState:
    """No voltage, no contraction."""
    return DriveState.single(np.zeros(2), np.zeros(2), 0.0)


@pytest.fixture(scope="session")
def rectangle():
    """Factory of a rectangular body's model; effects are given as instances, parameter values by name."""

    def make(
        length=0.1,
        height=0.005,
        clamped=True,
        youngs_modulus=1e5,
        poissons_ratio=0.3,
        retardation=0.0,
        plane="strain",
        gravity=0.0,
        effects=(),
        values=None,
        **numerics,
    ) -> Model:
        description = Description.model_validate(
            {
                "name": "rectangle",
                "body": {"length_m": length, "height_m": height, "clamped": clamped},
                "material": {
                    "plane": plane,
                    "gravity_m_per_s2": (0.0, -gravity),
                    "soft": {
                        "youngs_modulus_pa": youngs_modulus,
                        "poissons_ratio": poissons_ratio,
                        "density_kg_per_m3": 1000.0,
                        "retardation_time_s": retardation,
                    },
                },
                "markers": {"head": {"x_m": 0.0}, "middle": {"x_m": length / 2}, "tail": {"x_m": length}},
                "numerics": numerics,
            }
        )
        parameters = {}
        for effect in effects:
            for p in effect.parameters:
                name = f"{effect.id}.{p.name}"
                parameters[name] = Parameter(name, p.null, p.unit, p.lower, p.upper)
        return Model(description, tuple(effects), parameters).with_values(values or {})

    return make


@pytest.fixture(scope="session")
def tip_force() -> TipForce:
    """The effect that pushes the tail."""
    return TipForce()


@pytest.fixture(scope="session")
def equilibrium_of(still):
    """Nodal displacements [m] [nodes, 2] of a model at rest under all its loads, and its mesh."""

    def solve(model: Model):
        builder = Builder(model)
        position, _ = equilibrium(builder.system(), still, 1.0, 1e-11)
        return position[..., 0] - builder.mesh.nodes, builder.mesh

    return solve


@pytest.fixture(scope="session")
def swimmer() -> Model:
    """The default swimmer with amplitudes near those of a real one at 5.5 kV."""
    return (
        load_model("swimmer")
        .with_levels(np.array([5500.0]))
        .with_values({"amplitude_5500": 0.0624, "slope": 0.264})
    )


@pytest.fixture(scope="session")
def boxes():
    """Factory of a run driven by alternating boxes [V] at a frequency [Hz], filmed at 120 frames per second."""

    def make(duration=1.0, frequency=2.0, voltage=5500.0) -> Run:
        switches = np.arange(0.0, duration, 0.5 / frequency)
        upper = np.arange(len(switches)) % 2 == 0
        voltages = voltage * np.stack([upper, ~upper], axis=1).astype(float)
        time = np.arange(round(duration * 120) + 1) / 120
        return Run("boxes", time, DriveSchedule(switches, voltages))

    return make
