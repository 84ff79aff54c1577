"""One number of the model file that does what several effects do together."""

import json

import pytest
from hasel_sysid.estimation import fit_least_squares
from hasel_sysid.result import Status, improve
from hasel_sysid.ledger import Ledger
from hasel_sysid.testing.made_up_world import MadeUpWorld

DENSITY = "material.density_kg_per_m3"
TOGETHER = "payload", "pre_bend"


def heavier(share, **options):
    """What is found when the body is so many times as dense, which moves it as two effects do together."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: TOGETHER})
    truth = world.with_typical().with_freed(DENSITY).with_values({DENSITY: 900.0 * share})
    return improve(world.measured(truth), world.model, world.measured(truth), **options)


@pytest.mark.parametrize("share", [0.8, 1.2])
def test_one_wrong_number_comes_before_two_effects(share):
    """It is named with its value, no effect is said to be missing, and the error falls to the noise with it."""
    found = heavier(share)
    assert found.constant is not None
    assert found.constant.name == DENSITY
    assert abs(found.constant.parameter.value - 900.0 * share) < 3 * found.constant.parameter.standard_error
    assert len(found.constant.instead_of) > 1
    assert found.status is Status.UNEXPLAINED
    assert found.missing == ()
    assert [stage.added for stage in found.stages] == [(), (DENSITY,)]
    assert found.stages[-1].mae_validation < 0.2 * found.stages[0].mae_validation
    assert found.goodness.adequate
    assert DENSITY in found.reason and "900 kg/m^3" in found.reason
    assert found.diagnosis.probability_none == 1.0
    assert all(finding.probability == 0.0 for finding in found.diagnosis.findings)


def test_two_effects_that_no_number_does_are_missing():
    """The same two, one of them the other way round: the number that moves both is not taken for them."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: TOGETHER})
    truth = world.with_typical(*TOGETHER).with_values({"pre_bend.curvature": -0.3})
    found = improve(world.measured(truth), world.model)
    assert found.constant is None
    assert set(found.missing) == set(TOGETHER)


def test_a_number_may_do_what_no_effect_does():
    """It is named where no effect is."""
    world = MadeUpWorld(1, constants={DENSITY: ("stranger",)})
    truth = world.with_typical().with_freed(DENSITY).with_values({DENSITY: 1000.0})
    found = improve(world.measured(truth), world.model, only=("payload", "gravity_tilt"))
    assert found.constant.name == DENSITY
    assert found.constant.instead_of == frozenset()
    assert "no listed effect" in found.reason


def test_a_number_that_does_only_a_part_is_not_named():
    """A stranger's motion is there besides: the model with the number right does not describe its runs."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: ("other stranger",)})
    truth = world.with_typical().with_freed(DENSITY).with_values({DENSITY: 1000.0})
    assert improve(world.measured(truth, stranger=0.01), world.model).constant is None


def test_a_number_comes_before_effects_that_do_not_describe_the_runs_either():
    """A stranger's motion is there besides: what one number does as well, two effects do not do in part."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: TOGETHER})
    truth = world.with_typical().with_freed(DENSITY).with_values({DENSITY: 1080.0})
    found = improve(world.measured(truth, stranger=0.01), world.model, only=TOGETHER)
    assert not found.goodness.adequate
    assert found.constant.name == DENSITY
    assert found.constant.instead_of == frozenset(TOGETHER)
    assert found.status is Status.UNEXPLAINED


def test_a_single_effect_is_as_simple_as_a_number():
    """What one effect does is called by its name, though a number of the file does the same."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: TOGETHER[:1]})
    found = improve(world.measured(world.with_typical(TOGETHER[0])), world.model)
    assert found.constant is None
    assert found.missing == TOGETHER[:1]


def test_it_is_written_down(tmp_path):
    """The verdict, the ledger and the model file tell it: what was given, what was found, and in place of what."""
    ledger = Ledger(tmp_path)
    found = heavier(1.2, on_stage=ledger.add)
    written = found.to_json()["verdict"]["wrong_constant"]
    assert written["name"] == DENSITY
    assert written["given"] == 900.0
    assert written["instead_of"] == sorted(TOGETHER)
    assert found.to_json()["stages"][-1]["constant"] == DENSITY
    lines = [json.loads(line) for line in ledger.path.read_text().splitlines()]
    assert [line["constant"] for line in lines] == [None, DENSITY]
    assert DENSITY in (tmp_path / lines[-1]["model"]).read_text()


def test_a_number_that_comes_near_no_description_is_not_fitted_to_its_end(monkeypatch):
    """It is held against what a model may leave that describes its runs, and that is near the noise."""
    held = []

    def fitted(*arguments, goal, **options):
        held.append(goal)
        return fit_least_squares(*arguments, goal=goal, **options)

    monkeypatch.setattr("hasel_sysid.improvement.constant_fits.fit_least_squares", fitted)
    found = heavier(1.2)
    fit = found.constant.fit.evaluation
    assert held
    assert all(2 * fit.sum_of_squares < goal < 16 * fit.sum_of_squares for goal in held)
