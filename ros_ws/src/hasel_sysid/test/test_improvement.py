# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What an improvement finds in a made-up world, where it is known what every effect does."""

import json
import math

import pytest
from hasel_common.progress import Workload
from hasel_sysid.answer.diagnosis import Verdict
from hasel_sysid.answer.result import Improvement, Status
from hasel_sysid.command_line.improve import Ledger
from hasel_sysid.improvement import improve
from hasel_sysid.testing.made_up_world import MadeUpProblem, MadeUpWorld

DENSITY = "material.density_kg_per_m3"
TOGETHER = "payload", "pre_bend"


def improved(hidden, stranger=0.0, most_evaluations=math.inf, strange_at=None, **options) -> Improvement:
    """What is found when these effects, of typical size, and a stranger of so much rms are hidden."""
    world = MadeUpWorld(1, shared=16)
    measured = world.measured(
        world.with_typical(*hidden),
        stranger=stranger,
        most_evaluations=most_evaluations,
        strange_at=strange_at,
    )
    return improve(measured, world.model, **options)


@pytest.mark.parametrize(
    "hidden", [("payload",), ("quadratic_drag", "drive_creep"), ("slow_creep", "pre_bend", "gravity_tilt")]
)
def test_what_is_hidden_is_named(hidden):
    """One, two or three effects, and nothing beside them; each is said to be missing, the rest is not."""
    written = []
    found = improved(hidden, on_stage=written.append)
    assert set(found.missing) == set(hidden)
    assert found.status is Status.EXPLAINED
    assert {f.effect for f in found.diagnosis.findings if f.verdict is Verdict.MISSING} == set(hidden)
    assert found.diagnosis.findings[0].effect in hidden
    assert [stage.effects for stage in written] == [stage.effects for stage in found.stages]
    assert [len(stage.effects) for stage in found.stages] == list(range(len(hidden) + 1))
    assert "The search ended" not in found.reason and found.not_tried == []


@pytest.mark.parametrize("stranger", [0.0, 0.003, 0.005, 0.006])
def test_nothing_is_said_to_be_missing_only_where_the_model_describes_its_runs(stranger):
    """The reason and the status say the same, however large what no effect does at one of three voltages."""
    found = improved((), stranger=stranger, strange_at=4500.0, only=("payload", "pre_bend", "linear_drag"))
    assert found.reason.startswith("Nothing ") == (found.status is Status.NOTHING_MISSING)


def test_the_models_go_into_json_as_arviz_compares_them():
    """Every fitted model with its elpd, the difference to the best one with its error, weight, values and status."""
    found = improved(("payload",), only=("payload", "pre_bend", "linear_drag"))
    content = json.loads(json.dumps(found.to_json()))
    rows = content["models"]
    keys = {"effects", "elpd", "elpd_diff", "elpd_diff_error", "weight", "parameters", "status"}
    assert all(set(row) == keys for row in rows)
    assert [row["elpd"] for row in rows] == sorted((row["elpd"] for row in rows), reverse=True)
    (chosen,) = (row for row in rows if row["status"] == "chosen")
    (baseline,) = (row for row in rows if not row["effects"])
    assert chosen["effects"] == content["verdict"]["missing"] == ["payload"]
    assert chosen["parameters"] == {"payload.mass": pytest.approx(0.01, rel=0.05)}
    assert chosen["weight"] > 0.5 > baseline["weight"]
    assert baseline["elpd_diff"] > 2 * baseline["elpd_diff_error"] > 0.0
    assert baseline["parameters"] == {}


def test_what_is_missing_is_named_beside_an_inverted_angle():
    """Runs that move against the model are read the other way round, and that is said."""
    world = MadeUpWorld(1, shared=16)
    measured = world.measured(world.with_typical("slow_creep", "pre_bend")).experiments
    mirrored = MadeUpProblem(world, [-experiment.recording.sin_theta for experiment in measured])
    found = improve(mirrored, world.model, only=("slow_creep", "pre_bend", "payload"))
    assert "wrong sign in all runs" in str(found.set_up)
    assert set(found.missing) == {"slow_creep", "pre_bend"}


def test_nothing_hidden_is_nothing_missing():
    """The model is left as it was fitted."""
    found = improved(())
    assert found.status is Status.NOTHING_MISSING
    assert [stage.effects for stage in found.stages] == [()]


def test_what_explains_too_little_is_not_added():
    """Of a stranger's motion: it is said as tried, the model stays the baseline, and no effect is probable."""
    told = []
    found = improved((), stranger=0.02, on_stage=told.append)
    assert (found.status, found.missing) == (Status.UNEXPLAINED, ())
    assert set(found.refused) == set(told[-1].effects)
    assert [stage.effects for stage in found.stages] == [()]
    assert found.model.effects == ()
    assert not [f for f in found.diagnosis.findings if f.verdict is Verdict.MISSING]
    assert found.diagnosis.probability_none == 1.0
    assert not any(finding.probability for finding in found.diagnosis.findings)
    assert not found.goodness.adequate
    assert found.unexplained_fraction == 1.0


def test_what_is_missing_beside_a_stranger_is_not_probable_alone():
    """The effect is added, in part; that listed effects alone are missing is improbable, as more than noise is left."""
    found = improved(("payload",), stranger=0.01)
    assert found.status is Status.PARTLY_EXPLAINED
    assert found.diagnosis.findings[0].effect == "payload"
    assert found.diagnosis.probability_none == 1.0
    assert not any(finding.probability for finding in found.diagnosis.findings)


def test_the_number_of_effects_is_kept_to():
    """Three are hidden, two may be added: what is left is not called explained."""
    hidden = ("slow_creep", "pre_bend", "gravity_tilt")
    found = improved(hidden, most_effects=2, only=(*hidden, "payload", "quadratic_drag"))
    assert len(found.stages[-1].effects) <= 2
    assert found.status is not Status.EXPLAINED


def test_a_search_whose_time_is_over_leaves_what_was_done_and_lists_what_was_not_tried():
    """Each such effect is said not to be tried, and never that it is absent."""
    found = improved(("quadratic_drag", "drive_creep"), most_evaluations=0)
    assert "The search ended at the limit" in found.reason
    assert found.status is not Status.EXPLAINED
    assert found.stages[0].fit.mean_absolute_error > 0
    untried = {f.effect for f in found.diagnosis.findings if f.verdict is Verdict.NOT_TRIED}
    assert untried and untried <= set(found.not_tried)
    assert all(name in found.reason for name in untried)


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
    found = improve(world.measured(truth), world.model, world.measured(truth), only=("payload", "pre_bend"))
    assert found.missing == ("payload",)
    assert found.stages[-1].mae_validation < 0.5 * found.stages[0].mae_validation


def test_what_fits_but_does_not_predict_unseen_runs_is_not_complete():
    """The fitted runs lack nothing; the unseen ones, of a body with a payload, say that they are not like them."""
    world = MadeUpWorld(2)
    unseen = world.measured(world.with_typical("payload"))
    found = improve(world.measured(world.with_typical()), world.model, unseen, only=("payload", "pre_bend"))
    assert (found.status, found.missing) == (Status.UNEXPLAINED, ())
    assert "the unseen ones are not" in found.reason


@pytest.mark.parametrize("spread", [0.001, 0.006], ids=["by a tenth", "by half"])
def test_what_is_no_law_is_refused(spread):
    """Constancy: a mass that goes up with the voltage is not probable, however little it leaves with one value."""
    world = MadeUpWorld(1)
    truth = world.with_typical("payload")
    masses = {3500.0: 0.01 - spread, 4500.0: 0.01, 5500.0: 0.01 + spread}
    truths = {voltage: truth.with_values({"payload.mass": mass}) for voltage, mass in masses.items()}
    found = improve(world.measured_of_each(truths), world.model, only=("payload",))
    assert (found.status, found.missing, found.refused) == (Status.UNEXPLAINED, (), ("payload",))
    assert "by no law" in found.reason
    assert any("payload.mass would have to be" in sentence for sentence in found.contradictions)
    assert found.diagnosis.probability_none == 1.0
    assert found.diagnosis.findings[0].probability == 0.0


def heavier(share, **options) -> Improvement:
    """What is found when the body is so many times as dense, which moves it as two effects do together."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: TOGETHER})
    truth = world.with_typical().with_freed(DENSITY).with_values({DENSITY: 900.0 * share})
    return improve(world.measured(truth), world.model, world.measured(truth), **options)


@pytest.fixture(scope="module")
def denser(tmp_path_factory):
    """A body that is a fifth denser than its file says, with the ledger of the search."""
    ledger = Ledger(tmp_path_factory.mktemp("denser"))
    return heavier(1.2, on_stage=ledger.add), ledger


def test_one_wrong_number_comes_before_two_effects(denser):
    """It is named with its value, no effect is said to be missing, and the error falls to the noise with it."""
    found, _ = denser
    assert found.constant is not None
    assert found.constant.name == DENSITY
    assert abs(found.constant.parameter.value - 1080.0) < 3 * found.constant.parameter.standard_error
    assert found.constant.instead_of == frozenset()  # each effect alone predicts far worse
    assert (found.status, found.missing) == (Status.UNEXPLAINED, ())
    assert [stage.added for stage in found.stages] == [(), (DENSITY,)]
    assert found.stages[-1].mae_validation < 0.2 * found.stages[0].mae_validation
    assert found.goodness.adequate
    assert DENSITY in found.reason and "900 kg/m^3" in found.reason
    assert found.diagnosis.probability_none == 1.0
    assert all(finding.probability == 0.0 for finding in found.diagnosis.findings)


def test_a_wrong_number_is_written_down(denser):
    """The verdict, the ledger and the model file tell it: what was given, what was found, and in place of what."""
    found, ledger = denser
    written = found.to_json()["verdict"]["wrong_constant"]
    assert (written["name"], written["given"]) == (DENSITY, 900.0)
    assert written["value"] == pytest.approx(1080.0, rel=0.02)
    assert found.to_json()["stages"][-1]["constant"] == DENSITY
    lines = [json.loads(line) for line in ledger.path.read_text().splitlines()]
    assert [line["constant"] for line in lines] == [None, DENSITY]
    assert DENSITY in (ledger.folder / lines[-1]["model"]).read_text()


def test_two_effects_that_no_number_does_are_missing():
    """The same two, one of them the other way round: the number that moves both is not taken for them."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: TOGETHER})
    truth = world.with_typical(*TOGETHER).with_values({"pre_bend.curvature": -0.3})
    found = improve(world.measured(truth), world.model)
    assert found.constant is None
    assert set(found.missing) == set(TOGETHER)


def test_a_single_effect_is_as_simple_as_a_number():
    """What one effect does is called by its name, though a number of the file does the same."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: TOGETHER[:1]})
    found = improve(world.measured(world.with_typical(TOGETHER[0])), world.model)
    assert found.constant is None
    assert found.missing == TOGETHER[:1]


def test_a_number_may_do_what_no_effect_does():
    """It is named with its value where no effect is."""
    world = MadeUpWorld(1, constants={DENSITY: ("stranger",)})
    truth = world.with_typical().with_freed(DENSITY).with_values({DENSITY: 1000.0})
    found = improve(world.measured(truth), world.model)
    assert (found.status, found.missing) == (Status.UNEXPLAINED, ())
    assert found.constant.name == DENSITY
    assert found.constant.parameter.value == pytest.approx(1000.0, rel=0.01)
    assert found.constant.instead_of == frozenset()
    assert "does what no listed effect does" in found.reason


def test_an_effect_is_missing_however_loud_the_noise_if_runs_left_out_are_predicted_by_far_better():
    """Its share of all squares is small then, and the difference in elpd many times its error."""
    world = MadeUpWorld(2)
    loud = world.measured(world.with_typical("payload"), noise=0.05)
    assert improve(loud, world.model, only=("payload", "pre_bend")).missing == ("payload",)


def test_who_stops_a_search_keeps_the_fitted_baseline():
    """Ctrl-C in the middle: the first stage was handed over before anything was searched for."""
    world, written = MadeUpWorld(1, shared=16), []
    problem = world.measured(world.with_typical("payload"))

    def stopped(text, share):
        if "every effect alone" in text:
            raise KeyboardInterrupt

    problem.workload = Workload(tell=stopped)
    with pytest.raises(KeyboardInterrupt):
        improve(problem, world.model, on_stage=written.append)
    assert [stage.effects for stage in written] == [()]
