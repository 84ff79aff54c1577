# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Runs side by side give what each gives alone."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import EffectParameter, ForceEffect, MaterialEffect
from hasel_sim.effects.registry import catalogue
from hasel_sim.errors import ModelError, SimulationError
from hasel_sim.mesh.mesh import Region
from hasel_sim.model import Model, Parameter
from hasel_sim.run import Run, Simulation
from hasel_sim.simulate import simulate, simulate_many


class Gusts(ForceEffect):
    """A force that looks at time, voltage and contraction, which differ from lane to lane."""

    id = "gusts"
    depends_on = ("velocity", "contraction")
    parameters = (EffectParameter("strength", "g", "1", 0.0, 0.0, 10.0, 1.0),)

    def force(self, at, p):
        """Sideways and against the motion."""
        size = np.sin(9 * at.time) + at.voltage[0] / 5500.0 + 5 * at.contraction[-1]
        return p.strength * (size * np.array([0.0, 1.0]) - at.velocity)


class Tiring(MaterialEffect):
    """Muscles that stiffen with time."""

    id = "tiring"
    regions = (Region.SPINE,)
    parameters = (EffectParameter("modulus", "k", "Pa", 0.0, 0.0, 1e9, 1e6),)

    def first_piola(self, at, p):
        """Along the body."""
        return at.along_fibre(p.modulus * at.time * (at.stretch - 1.0))


def with_own(model: Model, *effects) -> Model:
    """The model with effects given as objects, at their typical values."""
    own = {
        f"{e.id}.{p.name}": Parameter(f"{e.id}.{p.name}", p.typical, p.unit, p.lower, p.upper)
        for e in effects
        for p in e.parameters
    }
    return Model(model.description, tuple(effects), {**model.parameters, **own})


def same(found: Simulation, expected: Simulation) -> None:
    """Angles to 1e-10, derivatives to 1e-6 of the largest of each or what round-off leaves of the smallest."""
    assert found.sin_theta == pytest.approx(expected.sin_theta, abs=1e-10, nan_ok=True)
    allowed = 1e-6 * np.nanmax(np.abs(expected.slopes), axis=0, initial=0.0) + 1e-8
    assert np.nanmax(np.abs(found.slopes - expected.slopes) / allowed, initial=0.0) < 1.0


@pytest.fixture(scope="module")
def runs(boxes):
    """Of several lengths, rates and starts; one with uneven frames."""
    uneven = np.array([-0.1, 0.0, 0.013, 0.05, 0.11, 0.2])
    schedule = DriveSchedule(np.array([0.0, 0.1]), np.array([[5500.0, 0.0], [0.0, 3000.0]]))
    return [
        boxes(duration=0.2),
        boxes(duration=0.3, voltage=4000.0),
        Run("uneven", uneven, schedule, initial_time=0.0),
        boxes(duration=0.25, frequency=3.5),
        boxes(duration=0.1),
    ]


def test_runs_of_any_lengths_give_what_they_give_alone(swimmer, runs):
    """Angles and derivatives, markers and shapes, in the order asked for."""
    names = ["amplitude_5500", "slope"]
    found = simulate_many([(swimmer, run) for run in runs], names, keep_shapes=True)
    for run, simulation in zip(runs, found, strict=True):
        expected = simulate(swimmer, run, names, keep_shapes=True)
        assert simulation.run is run
        same(simulation, expected)
        assert simulation.markers == pytest.approx(expected.markers, abs=1e-11, nan_ok=True)
        assert simulation.shapes == pytest.approx(expected.shapes, abs=1e-11, nan_ok=True)


@pytest.mark.parametrize("identity", list(catalogue()))
def test_values_of_an_effect_side_by_side_give_what_they_give_alone(identity, swimmer, boxes):
    """Every effect at three sizes, two of them alike, with the derivative by each of its parameters."""
    effect = catalogue()[identity]
    names = [f"{identity}.{p.name}" for p in effect.parameters]
    wet = swimmer.with_numerics(mesh_density=0.5).in_medium("canola_oil", 0.05)
    coarse, run = wet.with_effects(identity), boxes(duration=0.1)
    models = [
        coarse.with_values(
            {n: p.null + f * (p.typical - p.null) for n, p in zip(names, effect.parameters, strict=True)}
        )
        for f in (1.0, 0.5, 1.0)
    ]
    for model, found in zip(models, simulate_many([(m, run) for m in models], names), strict=True):
        same(found, simulate(model, run, names))


def test_an_effect_of_no_size_beside_one_of_some_gives_what_it_gives_alone(swimmer, boxes):
    """Two laws of stress in either model, of each of which the other has none."""
    pair, run = ("strain_softening", "spine_stiffening"), boxes(duration=0.1)
    coarse = swimmer.with_numerics(mesh_density=0.5).with_effects(*pair)
    models = []
    for effect in (e for e in coarse.effects if e.id in pair):
        models.append(coarse.with_values({f"{effect.id}.{p.name}": p.typical for p in effect.parameters}))
    models.append(coarse)
    for model, found in zip(models, simulate_many([(model, run) for model in models]), strict=True):
        same(found, simulate(model, run))


def test_an_effect_that_looks_at_its_drive_sees_that_of_its_own_lane(swimmer, runs):
    """Time, voltage and contraction."""
    model, names = with_own(swimmer, Gusts(), Tiring()), ["gusts.strength", "tiring.modulus", "slope"]
    for run, found in zip(runs, simulate_many([(model, run) for run in runs], names), strict=True):
        same(found, simulate(model, run, names))


def test_a_lane_that_fails_leaves_the_others_alone(swimmer, boxes, monkeypatch):
    """Its error comes back in its place; an unknown parameter's and a run without frames' likewise."""
    run, hard = boxes(duration=0.2), swimmer.with_values({"amplitude_5500": 0.6, "slope": 1e3})
    monkeypatch.setattr("hasel_sim.dynamics.integrator._MOST_HALVINGS", 0)
    monkeypatch.setattr("hasel_sim.dynamics.integrator.Stepper.follow.__defaults__", (0,))
    late = Run("late", run.time, run.schedule, initial_time=9.0)
    found = simulate_many([(swimmer, run), (hard, run), (swimmer, late), (swimmer, run)])
    assert isinstance(found[1], SimulationError)
    assert "could not be followed beyond" in str(found[1])
    assert "'late' has no frame after" in str(found[2])
    for index in (0, 3):
        same(found[index], simulate(swimmer, run))
    assert all(isinstance(e, ModelError) for e in simulate_many([(swimmer, run)] * 2, ["slop"]))


def test_a_step_divided_in_one_lane_is_as_it_is_alone(swimmer, boxes):
    """With its derivatives, beside a lane that needs no dividing."""
    run, names = boxes(duration=0.2), ["amplitude_5500"]
    hard = swimmer.with_values({"amplitude_5500": 0.4, "slope": 1e3})
    found = simulate_many([(swimmer, run), (hard, run)], names)
    same(found[0], simulate(swimmer, run, names))
    alone = simulate(hard, run, names)
    assert found[1].sin_theta == pytest.approx(alone.sin_theta, abs=1e-6)


def test_bodies_of_different_shapes_give_what_they_give_alone(swimmer, boxes):
    """Fins of three lengths in one call; the nodes of one are not those of another."""
    name, run = "body.spine.fin_length_m", boxes(duration=0.2)
    coarse = swimmer.with_numerics(mesh_density=0.5).with_freed(name)
    models = [coarse.with_values({name: length}) for length in (0.02, 0.03, 0.04)]
    together = simulate_many([(model, run) for model in models])
    for model, found in zip(models, together, strict=True):
        assert found.sin_theta == pytest.approx(simulate(model, run).sin_theta, abs=1e-9)
    assert np.abs(together[0].sin_theta - together[2].sin_theta).max() > 1e-3
