"""What a search asks of the sets that it knows."""

from hasel_sysid.data_gate.finding import error
from hasel_sysid.candidates import candidate_effects
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.improvement.judges import Judges
from hasel_sysid.selection import POLICY, choose, search
from hasel_sysid.selection.sets import NOTHING
from hasel_sysid.selection.simulated_sets import SimulatedSets
from hasel_sysid.testing.made_up_world import MadeUpWorld

PAYLOAD = frozenset({"payload"})
DENSITY = "material.density_kg_per_m3"
TOGETHER = frozenset({"payload", "pre_bend"})


def searched(world, measured, opposed=()):
    """What a search without judges finds, and the judges of it."""
    fit = fit_baseline(measured, world.model)
    sets = SimulatedSets(measured, fit, candidate_effects(fit.model, None))
    return search(sets, POLICY), Judges(sets, POLICY, opposed)


def test_what_explains_the_runs_describes_them_is_a_law_and_is_named():
    """The hidden effect; nothing at all is no name, and does not describe them."""
    world = MadeUpWorld(1, shared=16)
    found, judges = searched(world, world.measured(world.with_typical("payload")))
    assert judges.described(found, PAYLOAD)
    assert judges.lawful(found, PAYLOAD)
    assert judges.named(found, PAYLOAD)
    assert not judges.described(found, NOTHING)
    assert not judges.named(found, NOTHING)


def test_what_takes_away_too_little_is_not_named():
    """Of a stranger's motion the chosen effects imitate about a half."""
    world = MadeUpWorld(1, shared=16)
    found, judges = searched(world, world.measured(world.with_typical(), stranger=0.02))
    chosen = choose(found, POLICY).chosen
    assert chosen
    assert not judges.described(found, chosen)
    assert not judges.named(found, chosen)


def test_an_effect_that_grows_with_the_voltage_is_no_law():
    """Of the two that are hidden the other is one, alone and beside it."""
    world = MadeUpWorld(1)
    truth = world.with_typical(*TOGETHER)
    masses = {3500.0: 0.004, 4500.0: 0.01, 5500.0: 0.016}
    truths = {voltage: truth.with_values({"payload.mass": mass}) for voltage, mass in masses.items()}
    measured = world.measured_of_each(truths)
    found, judges = searched(world, measured)
    assert judges.lawless(found, TOGETHER) == PAYLOAD
    assert not judges.lawful(found, TOGETHER)
    assert judges.lawful(found, frozenset({"pre_bend"}))


def test_a_fault_of_the_set_up_leaves_nothing_to_name():
    """Whatever would explain runs that move against the model."""
    world = MadeUpWorld(1, shared=16)
    fault = error("mirrored", -1.0, "moves against the model", "look at the camera")
    found, judges = searched(world, world.measured(world.with_typical("payload")), [fault])
    assert not judges.named(found, PAYLOAD)
    assert judges.constant(found, TOGETHER) is None


def test_what_a_number_of_the_model_file_does_as_well_is_not_named():
    """A body that is denser moves as two effects together do."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: tuple(sorted(TOGETHER))})
    truth = world.with_typical().with_freed(DENSITY).with_values({DENSITY: 1080.0})
    found, judges = searched(world, world.measured(truth))
    chosen = choose(found, POLICY).chosen
    assert chosen >= TOGETHER
    assert judges.described(found, chosen)
    assert judges.constant(found, chosen).name == DENSITY
    assert not judges.named(found, chosen)
