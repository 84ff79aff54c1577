"""The search among sets of effects in a made-up world, where it is known what every effect does."""

import math

import pytest
from hasel_sysid.result import Verdict
from hasel_sysid.result import Status, improve
from hasel_sysid.selection.simulated_sets import SimulatedSets
from hasel_sysid.testing.made_up_world import MadeUpProblem, MadeUpWorld


def improved(hidden, stranger=0.0, most_effects=3, seed=1, most_evaluations=math.inf, on_stage=None):
    """What is found when these effects, of typical size, and a stranger of so much rms are hidden."""
    world = MadeUpWorld(seed, shared=16)
    measured = world.measured(
        world.with_typical(*hidden), stranger=stranger, most_evaluations=most_evaluations
    )
    return improve(measured, world.model, most_effects=most_effects, on_stage=on_stage)


@pytest.mark.parametrize(
    "hidden", [("payload",), ("quadratic_drag", "drive_creep"), ("slow_creep", "pre_bend", "gravity_tilt")]
)
def test_what_is_hidden_is_named(hidden):
    """One, two or three effects, and nothing beside them; each is said to be missing, the rest is not."""
    written = []
    found = improved(hidden, on_stage=written.append)
    assert set(found.missing) == set(hidden)
    assert found.status is Status.EXPLAINED
    said = {f.effect for f in found.diagnosis.findings if f.verdict is Verdict.MISSING}
    assert said == set(hidden)
    assert found.diagnosis.findings[0].effect in hidden
    assert [stage.effects for stage in written] == [stage.effects for stage in found.stages]
    assert [len(stage.effects) for stage in found.stages] == sorted({len(s.effects) for s in found.stages})


def test_beside_a_fault_of_the_set_up_no_pair_is_searched_for():
    """Runs that move against the model: nothing is named, in no more time than single effects take."""
    world = MadeUpWorld(1, shared=16)
    truth = world.with_typical("slow_creep", "pre_bend")
    flipped = [-experiment.recording.sin_theta for experiment in world.measured(truth).experiments]
    spent = []
    for most_effects in (1, 3):
        mirrored = MadeUpProblem(world, flipped)
        found = improve(mirrored, world.model, most_effects=most_effects)
        assert found.opposed
        assert found.status is Status.UNEXPLAINED
        assert found.missing == ()
        assert found.diagnosis.findings
        spent.append(mirrored.evaluations)
    assert spent[0] == spent[1]


def test_nothing_hidden_is_nothing_missing():
    """The model is left as it was fitted."""
    found = improved(())
    assert found.status is Status.NOTHING_MISSING
    assert [stage.effects for stage in found.stages] == [()]


@pytest.fixture(scope="module")
def stranger():
    """What is found when only a stranger is hidden, and the stages that were told on the way."""
    told = []
    return improved((), stranger=0.02, on_stage=told.append), told


def test_what_explains_too_little_is_not_added(stranger):
    """It is reported as tried, with what it would take away; the model stays the baseline, and nothing is missing."""
    found, tried = stranger
    assert found.status is Status.UNEXPLAINED
    assert set(found.refused) == set(tried[-1].effects)
    assert len(found.refused) > 0
    assert [stage.effects for stage in found.stages] == [()]
    assert found.model.effects == ()
    assert found.missing == ()
    assert not [f for f in found.diagnosis.findings if f.verdict is Verdict.MISSING]
    assert "of the error above the noise, which explains too little of it: not added" in found.reason
    assert not found.goodness.adequate
    assert found.unexplained_fraction == 1.0


def test_beside_a_stranger_no_listed_effect_is_probable(stranger):
    """However much likelier one is than the others: what is missing is none of them."""
    found, _ = stranger
    assert found.diagnosis.findings[0].effect in found.refused
    assert found.diagnosis.probability_none == 1.0
    assert not any(finding.probability for finding in found.diagnosis.findings)


def test_what_is_missing_beside_a_stranger_is_not_probable_alone():
    """The effect is added, in part; that listed effects alone are missing is improbable, as more than noise is left."""
    found = improved(("payload",), stranger=0.01)
    assert found.status is Status.PARTLY_EXPLAINED
    assert found.diagnosis.findings[0].effect == "payload"
    assert found.diagnosis.probability_none == 1.0
    assert not any(finding.probability for finding in found.diagnosis.findings)


def test_the_number_of_effects_is_kept_to():
    """Three are hidden, two may be added: what is left is not called explained."""
    found = improved(("slow_creep", "pre_bend", "gravity_tilt"), most_effects=2)
    assert len(found.stages[-1].effects) <= 2
    assert found.status is not Status.EXPLAINED


def test_a_search_whose_time_is_over_ends_in_good_order():
    """From no time at all to enough: it says what it had no time for, and never that this is absent."""
    hidden = ("quadratic_drag", "drive_creep")
    found = [improved(hidden, most_evaluations=most) for most in (0, math.inf)]
    assert "The search ended at the limit" in found[0].reason
    assert found[0].status is not Status.EXPLAINED
    untried = [f for f in found[0].diagnosis.findings if f.verdict is Verdict.NOT_TRIED]
    assert untried
    assert {f.effect for f in untried} <= set(found[0].not_tried)
    assert set(found[1].missing) == set(hidden)
    assert "The search ended" not in found[1].reason
    assert found[1].not_tried == []


def test_of_what_was_not_tried_nothing_is_said():
    """What is hidden was not looked at: only of the others it is known that they do not help."""
    world = MadeUpWorld(1, shared=16)
    measured = world.measured(world.with_typical("linear_drag"), most_evaluations=0)
    found = improve(measured, world.model, only=("gain_drift", "linear_drag"))
    assert "none of the effects that were tried foretells" in found.reason
    assert "not tried: linear_drag" in found.reason


def test_without_candidates_the_baseline_stays():
    """The only effect that was named is in the model already."""
    world = MadeUpWorld(1, shared=16)
    model = world.model.with_effects("payload")
    found = improve(world.measured(world.with_typical("payload")), model, only=("payload",))
    assert [stage.effects for stage in found.stages] == [()]
    assert found.diagnosis.findings == []


def test_unseen_runs_are_only_compared_with():
    """Every stage tells its error on them."""
    world = MadeUpWorld(2, shared=16)
    truth = world.with_typical("payload")
    found = improve(world.measured(truth), world.model, world.measured(truth))
    assert found.missing == ("payload",)
    assert found.stages[-1].mae_validation < 0.5 * found.stages[0].mae_validation


def test_what_is_no_law_is_not_fitted_to_its_last_digit(monkeypatch):
    """It is refused as it was found; what is a law beside it is gone on with."""
    finished = []
    original = SimulatedSets.finished

    def noted(sets, every):
        finished.extend(fitted.effects for fitted in every)
        return original(sets, every)

    monkeypatch.setattr(SimulatedSets, "finished", noted)
    world = MadeUpWorld(1)
    truth = world.with_typical("payload", "pre_bend")
    masses = {3500.0: 0.004, 4500.0: 0.01, 5500.0: 0.016}
    truths = {voltage: truth.with_values({"payload.mass": mass}) for voltage, mass in masses.items()}
    found = improve(world.measured_of_each(truths), world.model, only=("payload", "pre_bend"))
    assert found.refused == ("payload",)
    assert not [effects for effects in finished if "payload" in effects]


def test_what_is_no_law_is_not_probable_however_little_it_leaves():
    """A mass that goes up by a tenth with the voltage is near the noise with one value, which is refused."""
    world = MadeUpWorld(1)
    truth = world.with_typical("payload")
    masses = {3500.0: 0.009, 4500.0: 0.01, 5500.0: 0.011}
    truths = {voltage: truth.with_values({"payload.mass": mass}) for voltage, mass in masses.items()}
    found = improve(world.measured_of_each(truths), world.model, only=("payload",))
    assert found.status is Status.UNEXPLAINED
    assert found.refused == ("payload",)
    assert found.diagnosis.probability_none == 1.0
    assert found.diagnosis.findings[0].probability == 0.0
