"""Where the search for an effect starts."""

import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sysid.candidates import candidate_effects, resized, starts


def test_what_is_one_sided_starts_at_its_typical_size():
    """A slew limit at 2e-5 s/V, or at twice that."""
    (start,) = starts(catalogue()["current_limit"])
    assert start.values == {"current_limit.inverse_rate": 2e-5}
    assert resized(start, 2.0).values == {"current_limit.inverse_rate": 4e-5}


def test_what_may_have_either_sign_starts_at_its_null_only():
    """Its derivatives there tell the sign."""
    effect = catalogue()["muscle_asymmetry"]
    (start,) = starts(effect)
    assert start.changes_nothing
    assert resized(start, 2.0).values == start.values


def test_a_start_of_half_the_size_is_typical_of_its_own():
    """A payload of 5 g, whose signature is that of 5 g; a relaxation time keeps its length."""
    start = resized(starts(catalogue()["payload"])[0], 0.5)
    assert start.values == start.typical == {"payload.mass": 0.005}
    creep = starts(catalogue()["viscoelastic_creep"])[0]
    half = resized(creep, 0.5).values
    assert half["viscoelastic_creep.modulus_ratio"] == 0.5 * creep.values["viscoelastic_creep.modulus_ratio"]
    assert half["viscoelastic_creep.relaxation_time"] == creep.values["viscoelastic_creep.relaxation_time"]


def test_a_place_is_begun_from_everywhere_and_a_time_from_both_sides():
    """Derivatives lead from one relaxation time to another, and not past a place that hardly moves."""
    tether, creep = catalogue()["tether"], catalogue()["viscoelastic_creep"]
    assert {s.values["tether.position"] for s in starts(tether)} == {0.005, 0.05, 0.094, 0.15}
    assert len(starts(creep)) == 2


@pytest.mark.parametrize("name", catalogue())
def test_resized_starts_lie_within_the_range_and_leave_nuisances_alone(name):
    """A relaxation time or a position is scanned as before."""
    effect = catalogue()[name]
    for start in starts(effect):
        for p in effect.parameters:
            value = resized(start, 100.0).values[f"{name}.{p.name}"]
            assert p.lower <= value <= p.upper
            if p.scan:
                assert value == start.values[f"{name}.{p.name}"]


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
