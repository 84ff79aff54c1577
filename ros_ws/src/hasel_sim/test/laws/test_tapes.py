# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Laws in the compiled loop beside the same laws called as Python.

An additional stress at Gauss points: what it changes with the contraction of the muscles.
"""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.bench.cases import box_run, fitted_swimmer
from hasel_sim.build import Builder
from hasel_sim.dynamics.system import System
from hasel_sim.effects.registry import catalogue
from hasel_sim.laws import force_law, stress_law
from hasel_sim.laws.recording import NotTraceableError
from hasel_sim.mechanics.solid import Deformation
from hasel_sim.mechanics.state import DriveState, Motion
from hasel_sim.model import load_model
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.simulate import simulate_many

LAWS = [
    name
    for name, effect in catalogue().items()
    if effect.place == "force" or (effect.place == "material" and effect.regions)
]


def _systems(name: str, lanes: int, spread: float = 0.0) -> list[System]:
    """Of the coarse swimmer in oil, with an effect at typical values that differ a little from lane to lane."""
    coarse = fitted_swimmer().in_medium("canola_oil", 0.05).with_numerics(mesh_density=0.5).with_effects(name)
    out = []
    for lane in range(lanes):
        values = {f"{name}.{p.name}": p.typical * (1 + spread * lane) for p in catalogue()[name].parameters}
        out.append(PreparedRun(coarse.with_values(values), box_run(0.05)).stepper.system)
    return out


def _state(system: System) -> tuple[Motion, DriveState]:
    draw = np.random.default_rng(6).standard_normal
    shape = (*system.nodes.shape, system.lanes)
    moved = system.nodes[..., None] * (1 + 0.01 * np.arange(1, system.lanes + 1)) + 1e-5 * draw(shape)
    drive = DriveState(
        4e3 + draw((2, system.lanes)), 0.05 + 0.01 * draw((2, system.lanes)), draw(system.lanes)
    )
    return Motion(moved, 0.1 * draw(shape), draw(shape)), drive


@pytest.mark.parametrize("name", LAWS)
def test_compiled_and_as_written_they_agree(name):
    """Values to 1e-12, derivatives by motion, parameters and contraction as far as differences go, lane by lane."""
    each = _systems(name, 4, spread=0.1 if name != "tether" else 0.0)
    system = System.beside(each)
    (motion, drive), mesh = _state(system), system.solid.places
    for law in (*system.forces, *system.stresses):
        assert law.laws is not None
        wanted = [
            "value",
            "response",
            *((("p", p.name), 0) for p in law.effect.parameters),
            ("contraction", 0),
        ]
        for of in wanted:
            found = law.answers(of, motion, drive, mesh)
            expected = np.empty_like(found)
            law.fill(of, motion, drive, mesh, expected, exact=True)
            largest = np.abs(expected).max()
            assert np.abs(found - expected).max() <= (1e-12 if of == "value" else 1e-4) * largest
        assert np.abs(law.answers("value", motion, drive, mesh)).any()


def _refused(*_):
    raise NotTraceableError("the test wants it so")


@pytest.mark.parametrize("name", ["quadratic_drag", "force_length"])
def test_as_python_a_run_is_the_same_and_it_is_said_once(name, monkeypatch, capfd):
    """Series and derivatives of runs beside each other; one line names the effect, the factor and why."""
    coarse = fitted_swimmer().with_numerics(mesh_density=0.5).with_effects(name)
    model = coarse.with_values({f"{name}.{p.name}": p.typical for p in catalogue()[name].parameters})
    cases, names = (
        [(model, box_run(0.1, *drive)) for drive in ((5500.0, 2.0), (4500.0, 10.0))],
        list(model.parameters),
    )
    compiled = simulate_many(cases, names)
    monkeypatch.setattr(force_law, "force_law", _refused)
    monkeypatch.setattr(stress_law, "stress_law", _refused)
    monkeypatch.setattr("hasel_sim.laws.python_calls._said", set())
    called = simulate_many(cases, names)
    simulate_many(cases, names)
    for one, other in zip(compiled, called, strict=True):
        assert one.sin_theta == pytest.approx(other.sin_theta, abs=1e-7)
        scale = np.abs(other.slopes).max(axis=0)
        assert np.abs((one.slopes - other.slopes) / np.where(scale > 0, scale, 1.0)).max() < 1e-4
    said = capfd.readouterr().err
    assert said.count(f"effect '{name}' runs as Python") == 1
    assert "times as long: the test wants it so" in said


def test_lanes_without_the_effect_are_left_alone():
    """Where the sites of a lane are others, as of a tether elsewhere, its law is there and not here."""
    near, far = _systems("tether", 2)
    (law,) = far.forces
    law.sites.nodes[:] = law.sites.nodes[:, ::-1]
    system = System.beside([near, far])
    motion, drive = _state(system)
    first, second = (law.value(motion, drive) for law in system.forces)
    assert first[..., 0].any() and not first[..., 1].any()
    assert second[..., 1].any() and not second[..., 0].any()


def test_a_parameter_is_differentiated_beside_the_end_of_its_range():
    """At null, where what holds a root of its square has a kink, the derivative is that of values above."""
    (system,) = _systems("skin_friction", 1)
    (law,) = system.forces
    law._use_lanes(
        [
            SimpleNamespace(
                own=SimpleNamespace(along=0.0, thinning=0.0), surroundings=law.values[0].surroundings
            )
        ]
    )
    motion, drive = _state(system)
    assert np.abs(law.answers((("p", "along"), 0), motion, drive, force_law.NO_MESH)).max() > 1e-3


@pytest.mark.parametrize(("effect", "contracts"), [("strain_softening", False), ("force_length", True)])
def test_one_that_does_not_ask_for_the_contraction_is_not_differentiated_by_it(effect, contracts):
    """Its law says so; of one that does, the derivative is that of its stress."""
    model = load_model("swimmer").with_effects(effect)
    typical = {f"{effect}.{p.name}": p.typical for p in model.effects[0].parameters}
    system = Builder(model.with_values(typical)).system()
    (law,) = system.stresses
    bent = 1.01 * system.nodes[..., None]
    at = Deformation(system.solid, Motion(bent, np.zeros_like(bent), np.zeros_like(bent)))
    more, drive, less = (
        DriveState.single(np.zeros(2), np.array([0.05 + step, 0.0]), 0.0) for step in (1e-4, 0.0, -1e-4)
    )
    slopes = law.contraction_slopes(at, drive)
    change = (law.stress(at, more) - law.stress(at, less)) / 2e-4
    assert bool(np.abs(change).any()) is contracts
    assert len(slopes) == (2 if contracts else 0)
    if contracts:
        assert slopes[0] == pytest.approx(change, rel=1e-6)
