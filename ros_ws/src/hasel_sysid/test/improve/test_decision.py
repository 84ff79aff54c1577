"""Whether a diagnosis gives reason to add an effect."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sysid.diagnosis import Verdict
from hasel_sysid.improve import Stage
from hasel_sysid.improve.decision import decide

FRAMES, NOISE = 2000, 0.0024


def fit(error):
    """A fit whose residual is evenly spread over two runs."""
    residual = np.full(FRAMES, error)
    return SimpleNamespace(
        mean_absolute_error=error,
        evaluation=SimpleNamespace(
            residual=residual,
            sum_of_squares=float(residual @ residual),
            jacobian=np.ones((FRAMES, 1)),
            runs=np.repeat([0, 1], FRAMES // 2),
        ),
    )


def finding(verdict, error, at_edge=False):
    """Of an effect whose full fit leaves this error."""
    fitted = fit(error)
    size = SimpleNamespace(name="size", null=0.0)
    fitted.model = SimpleNamespace(
        effects=[SimpleNamespace(id="drag", parameters=[size])], values={"drag.size": 10.0}
    )
    fitted.at_bound, fitted.undetermined = (("drag.size",) if at_edge else ()), ()
    return SimpleNamespace(effect="drag", verdict=verdict, fit=fitted)


def decided(before, after=None, chance=0.002, mesh=0.0, explained=0.9, refuted=None):
    """The decision on one effect that brings the error from `before` to `after`, or on one that did but is refuted."""
    findings = [] if after is None else [finding(Verdict.MISSING, after)]
    if refuted:
        findings = [finding(Verdict.MISSING_IF_SIZE_MATTERS, 0.0025, refuted == "edge")]
    diagnosis = SimpleNamespace(
        p_value=chance,
        findings=findings,
        suspects={"mesh": mesh},
        explained=explained,
        ceiling=0.9,
        noise=SimpleNamespace(mean_absolute=NOISE),
        context=SimpleNamespace(base=before**2, excess=before**2 - min(NOISE, 0.95 * before) ** 2),
    )
    return decide(Stage((), fit(before), None), diagnosis)


def test_an_effect_that_removes_the_error_is_accepted():
    """Well above the noise, and no other suspect."""
    assert decided(0.01, 0.0025).accepted.effect == "drag"


@pytest.mark.parametrize(
    ("arguments", "reason", "negligible"),
    [
        ({"before": 0.0025, "after": 0.0024, "chance": 0.3}, "noise alone looks like this", False),
        # significant, but no more than what another mesh leaves
        ({"before": 0.00246, "after": 0.0024}, "Nothing that matters", True),
        # correlated noise is not known better than that
        ({"before": 0.0029}, "the error is 1.21 times the noise's", True),
        ({"before": 0.005, "after": 0.0025, "mesh": 0.8}, "The mesh explains 80%", False),
        ({"before": 0.01, "explained": 0.3}, "None of the listed effects", False),
        ({"before": 0.01, "explained": 0.97, "refuted": "edge"}, "only at the edge of its range", False),
        ({"before": 0.01, "explained": 0.97, "refuted": "left out"}, "foretells runs left out", False),
    ],
)
def test_reasons_to_add_nothing(arguments, reason, negligible):
    """Noise, a trifle, the numerics, nothing that fits: each is said, and only the trifle is negligible."""
    decision = decided(**arguments)
    assert decision.accepted is None
    assert reason in decision.reason
    assert decision.negligible is negligible


@pytest.mark.parametrize(
    ("arguments", "alone"),
    [
        ({"explained": 0.3}, True),
        ({"mesh": 0.8}, False),
        ({"chance": 0.3}, False),
        ({"after": 0.0025}, False),
    ],
)
def test_only_where_no_effect_alone_explains_are_two_worth_a_try(arguments, alone):
    """Neither where noise or the numerics do, nor where one does."""
    assert decided(0.01, **arguments).none_alone is alone


def test_what_finer_numerics_would_remove_too_is_not_to_an_effects_credit():
    """An effect that brings the error to the noise, most of which half the time step would bring as well."""
    before, after = 0.00265, 0.0024
    assert decided(before, after).accepted is not None
    found = decided(before, after, mesh=0.67)
    assert found.accepted is None
    assert found.negligible
    assert "of which finer numerics would remove 12" in found.reason
    assert decided(0.01, 0.0025, mesh=0.67).accepted is not None
