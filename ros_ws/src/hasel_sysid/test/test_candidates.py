# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a model may lack or have wrong."""

import pytest
from hasel_sim.model import load_model
from hasel_sysid.candidates import Candidate, candidate_effects, compatible, constants_of, effects_of

DENSITY = "material.density_kg_per_m3"


def test_a_plus_adds_to_the_catalogue_and_without_one_nothing_else_is_considered(tmp_path):
    """An effect of one's own beside the built-in ones, or alone."""
    model = load_model("swimmer")
    own = tmp_path / "mine.py"
    own.write_text(
        "from hasel_sim.effects.base import DriveEffect, EffectParameter\n\n\n"
        "class Mine(DriveEffect):\n"
        '    physics, equation = "Less voltage arrives.", "V <- (1 - k) V"\n'
        '    parameters = (EffectParameter("k", "k", "1", 0.0, 0.0, 0.5, 0.1),)\n\n'
        "    def respond(self, time, signal, p):\n"
        "        return (1 - p.k) * signal\n"
    )
    every = [effect.id for effect in candidate_effects(model)]
    assert [effect.id for effect in candidate_effects(model, (f"+{own}:Mine",))] == [*every, "Mine"]
    assert [effect.id for effect in candidate_effects(model, (f"{own}:Mine", "tether"))] == ["Mine", "tether"]
    assert [effect.id for effect in candidate_effects(model, ("+tether",))] == every


def test_forces_of_a_fluid_are_suspects_only_where_there_is_one():
    """The search considers them for a model with a medium, and spends nothing on them for one without."""
    dry = {effect.id for effect in candidate_effects(load_model("swimmer"))}
    swimmer = load_model("swimmer_in_oil")
    wet = {
        effect.id for effect in candidate_effects(swimmer.without_effects(*(e.id for e in swimmer.effects)))
    }
    of_fluids = {
        "form_drag",
        "viscous_drag",
        "normal_drag",
        "skin_friction",
        "reactive_force",
        "finite_depth_added_mass",
    }
    assert wet - dry == {*of_fluids, "form_drag"} and dry < wet


@pytest.fixture
def candidates() -> dict[str, Candidate]:
    """Effects and constants of the swimmer, by name."""
    model = load_model("swimmer")
    return {one.name: one for one in (*effects_of(model), *constants_of(model))}


def test_what_does_the_same_goes_not_into_one_model(candidates):
    """A camera's latency and a dead time exclude each other; a payload goes with either, and with itself not."""
    latency, delay, payload = (candidates[n] for n in ("camera_latency", "transport_delay", "payload"))
    assert not compatible([latency, delay])
    assert compatible([latency, payload]) and compatible([delay, payload])
    assert not compatible([payload, payload])


def test_a_constant_of_the_file_is_a_candidate_alone(candidates):
    """A number that is wrong is to be measured before effects are believed in beside it."""
    assert compatible([candidates[DENSITY]])
    assert not compatible([candidates[DENSITY], candidates["payload"]])


def test_a_constant_ranges_around_what_the_file_says(candidates):
    """Its null is the file's value, which it has when it is added; what is free already is no candidate."""
    model, density = load_model("swimmer"), candidates[DENSITY]
    (p,) = density.parameters
    added = density.added_to(model)
    assert added.values[DENSITY] == p.null == model.with_freed(DENSITY).values[DENSITY]
    assert p.lower < p.null < p.typical < p.upper
    assert density.is_constant and DENSITY in added.parameters and DENSITY not in model.parameters
    assert DENSITY not in {one.name for one in constants_of(added)}


def test_an_effect_is_added_at_its_null(candidates):
    """And found there by its name; its size and its time are told apart."""
    creep = candidates["viscoelastic_creep"]
    added = creep.added_to(load_model("swimmer"))
    assert [effect.id for effect in added.effects] == [creep.name]
    assert all(added.values[path] == p.null for path, p in creep.sizes.items())
    assert list(creep.coordinates) == ["viscoelastic_creep.relaxation_time"]
