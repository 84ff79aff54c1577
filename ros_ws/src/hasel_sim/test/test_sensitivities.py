# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Derivatives of the angle series by every kind of parameter, against central differences."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.dynamics.parameter_columns import SolidSlope
from hasel_sim.effects.base import (
    DriveEffect,
    DriveStage,
    EffectParameter,
    ForceEffect,
    MaterialEffect,
    ObservationEffect,
)
from hasel_sim.errors import SimulationError
from hasel_sim.mesh.mesh import Region
from hasel_sim.model import Model, Parameter
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


class Drag(ForceEffect):
    """Quadratic drag on the skin."""

    id = "drag"
    sites = "skin"
    depends_on = ("velocity", "tangent")
    parameters = (EffectParameter("coefficient", "c", "kg/m^3", 0.0, 0.0, 1e4, 200.0),)

    def force(self, at, p: SimpleNamespace):
        """Against the normal speed."""
        speed = (at.velocity * at.normal).sum(axis=1, keepdims=True)
        return -p.coefficient * np.abs(speed) * speed * at.normal


class Softer(MaterialEffect):
    """Another shear modulus."""

    id = "softer"
    parameters = (EffectParameter("factor", "k", "1", 1.0, 0.1, 3.0, 1.2),)

    def modify(self, coefficients, p: SimpleNamespace):
        """Scale the soft part."""
        coefficients.shear[coefficients.region != Region.SPINE] *= p.factor


class Bent(MaterialEffect):
    """A bent rest shape."""

    id = "bent"
    parameters = (EffectParameter("curvature", "k", "1/m", 0.0, -5.0, 5.0, 1.0),)

    def modify(self, coefficients, p: SimpleNamespace):
        """Stretch one side."""
        coefficients.rest_stretch += p.curvature * coefficients.height


class Creep(MaterialEffect):
    """One Maxwell branch."""

    id = "creep"
    parameters = (
        EffectParameter("ratio", "g", "1", 0.0, 0.0, 2.0, 0.3),
        EffectParameter("time", "tau", "s", 0.1, 0.01, 10.0, 0.1),
    )

    def branches(self, p: SimpleNamespace):
        """One."""
        return [(p.ratio, p.time)]


class Stiffening(MaterialEffect):
    """Muscles that stiffen with the square of their contraction."""

    id = "stiffening"
    regions = (Region.UPPER_MUSCLE, Region.LOWER_MUSCLE)
    parameters = (EffectParameter("modulus", "k", "Pa", 0.0, 0.0, 1e9, 1e6),)

    def first_piola(self, at, p: SimpleNamespace):
        """Along the fibres."""
        P = np.zeros_like(at.deformation)
        P[:, :, 0] = (p.modulus * at.contraction**2)[:, None] * (at.deformation[:, :, 0] - [1.0, 0.0])
        return P


class Weaker(DriveEffect):
    """Less voltage at the lower muscle."""

    id = "weaker"
    stage = DriveStage.TARGET
    parameters = (EffectParameter("share", "b", "1", 0.0, -0.9, 0.9, 0.2),)

    def respond(self, time, signal, p: SimpleNamespace):
        """Scaled."""
        return signal * [1.0, 1.0 - p.share]


class Saturating(ObservationEffect):
    """A measured angle that saturates."""

    id = "saturating"
    parameters = (EffectParameter("cubic", "c", "1", 0.0, -10.0, 10.0, 1.0),)

    def angle(self, time, sin_theta, p: SimpleNamespace):
        """Cubic."""
        return sin_theta - p.cubic * sin_theta**3


CASES = {
    "amplitude_5500": ((), {}),
    "slope": ((), {}),
    "drag.coefficient": ((Drag(),), {"drag.coefficient": 200.0}),
    "softer.factor": ((Softer(),), {"softer.factor": 1.2}),
    "bent.curvature": ((Bent(),), {"bent.curvature": 1.0}),
    "creep.ratio": ((Creep(),), {"creep.ratio": 0.3}),
    "creep.time": ((Creep(),), {"creep.ratio": 0.3}),
    "stiffening.modulus": ((Stiffening(),), {"stiffening.modulus": 5e6}),
    "weaker.share": ((Weaker(),), {"weaker.share": 0.2}),
    "saturating.cubic": ((Saturating(),), {"saturating.cubic": 1.0}),
}
ALL = (Drag(), Softer(), Creep(), Stiffening(), Weaker(), Saturating())


def _with(model: Model, effects, values) -> Model:
    declared = {
        f"{e.id}.{p.name}": Parameter(f"{e.id}.{p.name}", p.null, p.unit, p.lower, p.upper)
        for e in effects
        for p in e.parameters
    }
    tight = model.with_numerics(tolerance_m=1e-14, mesh_density=0.5)
    return Model(tight.description, effects, {**tight.parameters, **declared}).with_values(values)


def _differences(model: Model, run: Run, name: str) -> np.ndarray:
    """Fourth-order central differences of sin theta."""
    value = model.parameters[name].value
    step = 1e-3 * abs(value)

    def series(factor):
        return simulate(model.with_values({name: value + factor * step}), run).sin_theta

    return (8 * (series(1) - series(-1)) - (series(2) - series(-2))) / (12 * step)


@pytest.mark.parametrize("name", CASES)
def test_each_kind_of_parameter(name, swimmer, boxes):
    """Exact to 1e-6 of the largest derivative, for effects at every place, alone in the model."""
    effects, values = CASES[name]
    model, run = _with(swimmer, effects, values), boxes(duration=0.5)
    found = simulate(model, run, [name]).slopes[:, 0]
    expected = _differences(model, run, name)
    assert np.abs(expected).max() > 0
    assert np.abs(found - expected).max() < 1e-6 * np.abs(expected).max()


def test_all_parameters_at_once_with_all_effects_together(swimmer, boxes):
    """Columns do not disturb each other."""
    values = {name: value for effects, values in CASES.values() for name, value in values.items()}
    del values["bent.curvature"]
    values["amplitude_5500"] = 0.0213
    model, run = _with(swimmer, ALL, values), boxes(duration=0.3, frequency=4.0)
    names = list(model.parameters)
    found = simulate(model, run, names).slopes
    for column, name in enumerate(names):
        expected = _differences(model, run, name)
        assert np.abs(found[:, column] - expected).max() < 1e-6 * np.abs(expected).max(), name


def test_the_default_tolerance_is_good_enough_for_fitting(swimmer, boxes):
    """With the default solver tolerance the derivatives are those of a tight one to 1e-4."""
    run, names = boxes(duration=0.5), ["amplitude_5500", "slope"]
    loose = simulate(swimmer, run, names)
    tight = simulate(swimmer.with_numerics(tolerance_m=1e-14), run, names)
    assert np.abs(loose.sin_theta - tight.sin_theta).max() < 1e-6
    assert np.abs(loose.slopes - tight.slopes).max() < 1e-4 * np.abs(tight.slopes).max()


def test_a_parameter_that_is_not_used_has_no_derivative(swimmer, boxes):
    """The amplitude of a voltage that does not occur."""
    model = swimmer.with_levels(np.array([5500.0, 9000.0]))
    assert not simulate(model, boxes(duration=0.2), ["amplitude_9000"]).slopes.any()


def test_derivatives_that_are_no_numbers_are_an_error_and_no_result(swimmer, boxes, monkeypatch):
    """Where the matrix of a step is singular, or a law has no derivative; the run itself is found."""
    run, name = boxes(duration=0.1), "soft_modulus.scale"
    model = swimmer.with_effects("soft_modulus")
    assert np.isfinite(simulate(model, run).sin_theta).all()

    def without_width(builder, asked):
        known = residual_slope(builder, asked)
        return SolidSlope(known.more, known.less, np.nan) if asked == name else known

    residual_slope = Builder.residual_slope
    monkeypatch.setattr(Builder, "residual_slope", without_width)
    with pytest.raises(SimulationError, match="its derivatives were not"):
        simulate(model, run, [name])
