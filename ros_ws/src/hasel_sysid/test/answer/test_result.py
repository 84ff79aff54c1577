# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is said of an effect: one answer, and no number that nobody can believe."""

import json
import math

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.answer.diagnosis import Diagnosis, Finding, Verdict, diagnosis_json
from hasel_sysid.answer.result import open_values
from hasel_sysid.noise import NoiseModel
from hasel_sysid.testing.made_up_runs import made_up_fit

RANGE = (0.0, 0.3)
NAMES = ("soft_modulus.scale", "strain_softening.softening", "payload.mass")
EFFECTS = ("soft_modulus", "strain_softening", "payload")


def finding(verdict: Verdict, effect: str = "tilt", **changes) -> Finding:
    """Of a tilt in radians that is plausible up to 0.3, or of another effect like it."""
    given = {
        "probability": 0.0,
        "error_removed": 0.0,
        "expected": {f"{effect}.angle": (0.1, 0.01)},
        "units": {f"{effect}.angle": "rad"},
        "swallowed": 0.03,
        "visible_above": 0.01,
        "plausible": RANGE,
    }
    return Finding(effect, verdict, **{**given, **changes})


@pytest.mark.parametrize("limit", [18.0, 540.0, math.inf])
def test_a_threshold_beyond_the_plausible_range_is_said_as_such(limit):
    """Not 18 rad, nor inf Pa."""
    said = str(finding(Verdict.CANNOT_BE_SEEN, visible_above=limit))
    assert said == "tilt cannot be seen: no plausible size (up to 0.3 rad) would show in these recordings."
    said = str(finding(Verdict.CANNOT_BE_SEEN, visible_above=limit, swallowed=0.98))
    assert "imitate 98% of it, and of what is left no plausible size (up to 0.3 rad) would show" in said


def test_an_estimate_beyond_the_plausible_range_is_no_number():
    """Not −322 kg/m^2."""
    found = finding(Verdict.MISSING_IF_SIZE_MATTERS, expected={"tilt.angle": (-322.0, 10.0)})
    assert "-322" not in str(found)
    assert "beyond its plausible range" in str(found)


def test_an_absent_effect_that_would_imitate_another_is_absent_beside_it():
    """Both numbers in one sentence, and of which model each is."""
    said = str(finding(Verdict.ABSENT, error_removed=0.58, winner="gain_drift"))
    assert said == (
        "tilt is absent: above 0.01 rad it would have been seen beside gain_drift; without gain_drift it would imitate "
        "58% of what that explains."
    )
    assert str(finding(Verdict.ABSENT)) == "tilt is absent: above 0.01 rad it would have been seen."


def test_an_effect_that_could_not_be_tried_has_no_threshold():
    """Not inf."""
    said = str(finding(Verdict.INCONCLUSIVE, expected={}, visible_above=math.inf))
    assert "inf" not in said
    assert "could not be simulated" in said


def test_groups_of_what_is_ruled_out_are_not_told():
    """Who among the absent looks like whom is no question."""
    findings = [
        finding(Verdict.ABSENT),
        finding(Verdict.ABSENT, "sag"),
        finding(Verdict.MISSING, "drag"),
        finding(Verdict.ABSENT, "friction"),
    ]
    groups = [("drag", "friction"), ("sag", "tilt")]
    assert diagnosis(*findings, groups=groups).groups_in_question == [("drag", "friction")]


def diagnosis(*findings: Finding, groups: list[tuple[str, ...]] = []) -> Diagnosis:  # noqa: B006
    """Of a fitted beam."""
    noise = NoiseModel(1e-6, 0.0, 0.5)
    fit = made_up_fit(load_model("beam"), 0.01)
    return Diagnosis(list(findings), groups, noise, noise, 0.0, 0.0, 0.0, 0.0, {}, fit)


def test_of_a_model_that_describes_no_run_no_effect_is_absent():
    """Nor undecided, nor invisible: nobody can know yet; what was added is missing, and nothing else is."""
    said = diagnosis(
        finding(Verdict.ABSENT),
        finding(Verdict.MISSING, "drag"),
        finding(Verdict.CANNOT_BE_SEEN, "sag"),
        finding(Verdict.NOT_TRIED, "play"),
    )
    verdicts = [f.verdict for f in said.seen_beside(False, ("play",)).findings]
    assert verdicts == [
        Verdict.NOT_JUDGED,
        Verdict.MISSING_IF_SIZE_MATTERS,
        Verdict.NOT_JUDGED,
        Verdict.MISSING,
    ]
    assert said.seen_beside(True).findings == said.findings
    assert said.not_tried == ["play"]


def test_where_no_effect_is_wrong_none_is_probable():
    """Some could at most stand in its place."""
    said = diagnosis(finding(Verdict.MISSING, probability=0.9)).of_no_effect()
    assert said.probability_none == 1.0 and said.best is None
    assert (said.findings[0].verdict, said.findings[0].probability) == (Verdict.MISSING_IF_SIZE_MATTERS, 0.0)


def test_what_is_not_finite_is_null_in_json():
    """A threshold or a standard error that no number tells."""
    open_end = finding(
        Verdict.CANNOT_BE_SEEN, visible_above=math.inf, expected={"tilt.angle": (0.1, math.inf)}
    )
    (row,) = diagnosis_json(diagnosis(open_end))["ranking"]
    assert row["visible_above"] is None and row["expected"]["tilt.angle"]["std"] is None
    json.dumps(row, allow_nan=False)


def fitted(errors, correlation=0.0):
    """A beam that is softer, softens and carries 1.7 kg/m; the first two of these errors are correlated."""
    model = (
        load_model("beam").with_effects(*EFFECTS).with_values(dict(zip(NAMES, (0.6, 0.4, 1.7), strict=True)))
    )
    covariance = np.diag(np.square(errors))
    covariance[0, 1] = covariance[1, 0] = correlation * errors[0] * errors[1]
    return model.with_covariance(NAMES, covariance)


def test_two_of_which_only_the_sum_is_known_are_said_to_be_so():
    """Softer by itself, or softer when strained: both intervals hold the value at which the effect does nothing."""
    found = open_values(fitted((1.6, 1.7, 0.1), -0.999), EFFECTS)
    softer, softening = found["soft_modulus"], found["strain_softening"]
    assert softer == (
        "soft_modulus.scale is not known: its interval holds 1, at which it does nothing; "
        "strain_softening.softening can do the same (correlation -1.00)."
    )
    assert softening.startswith("strain_softening.softening is not known: its interval holds 0,")


def test_what_nothing_else_can_do_is_still_not_known():
    """A wide interval alone is said as well, without naming another."""
    found = open_values(fitted((0.01, 0.01, 1.0)), EFFECTS)
    assert list(found) == ["payload"]
    assert (
        found["payload"] == "payload.mass is not known: its interval holds 0 kg/m, at which it does nothing."
    )


@pytest.mark.parametrize("correlation", [0.0, 0.999])
def test_of_values_that_are_known_nothing_is_said(correlation):
    """However much two of them go together."""
    assert open_values(fitted((0.01, 0.01, 0.1), correlation), EFFECTS) == {}


def test_only_what_was_added_is_spoken_of():
    """An effect that the model had before is no answer."""
    assert open_values(fitted((1.6, 1.7, 0.1), -0.999), ("payload",)) == {}
