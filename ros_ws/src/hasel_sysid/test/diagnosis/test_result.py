"""What is said of an effect: one answer, and no number that nobody can believe."""

import math

import pytest
from hasel_sysid.result import Diagnosis, Finding, Verdict
from hasel_sysid.noise.model import NoiseModel

RANGE = (0.0, 0.3)


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
    found = Diagnosis(findings, groups, NoiseModel(1e-6, 0.0, 0.5), 0.0, 0.0, 0.0, 0.0)
    assert found.groups_in_question == [("drag", "friction")]
