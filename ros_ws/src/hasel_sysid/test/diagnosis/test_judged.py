"""What is said of all effects at once."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sysid.diagnosis import Verdict, judged

ERROR = {"standard_error": 0.1}


@pytest.fixture(autouse=True)
def _nothing_simulated(monkeypatch):
    """No finer numerics, and no features for a learned residual."""
    monkeypatch.setattr("hasel_sysid.diagnosis.judgement.with_numerical_error", lambda fit, changes: fit)
    monkeypatch.setattr(
        "hasel_sysid.diagnosis.judgement.regressors", lambda evaluation: np.zeros((len(evaluation.runs), 0))
    )


def test_one_more_full_fit_can_change_the_ranking(context):
    """Before only another shape was fitted, which explains nothing; then comes the one that was hidden."""
    whole = context(0.01)
    for name, final in whole.finals.items():
        final.model.parameters = {f"{name}.size": SimpleNamespace(**ERROR)}
    sine = whole.finals.pop("sine")
    del whole.finals["much_alike"], whole.squares["sine"], whole.squares["much_alike"]
    before = judged(whole)
    assert all(finding.verdict is not Verdict.MISSING for finding in before.findings)
    assert before.explained < 0.1

    after = judged(before.context.with_fit("sine", sine))
    assert (after.best.effect, after.best.verdict) == ("sine", Verdict.MISSING)
    assert after.best.probability > 0.9 and after.explained > 0.9
    assert after.probability_none < 0.1 < before.probability_none


def test_what_cannot_be_told_from_the_winner_is_not_absent(context):
    """One answer of one effect: it is named in the winner's group, so it could stand in its place."""
    whole = context(0.01)
    for name, final in whole.finals.items():
        final.model.parameters = {f"{name}.size": SimpleNamespace(**ERROR)}
    found = judged(whole)
    group = next(group for group in found.groups if found.best.effect in group)
    assert len(group) > 1
    for name in group:
        assert found.finding(name).verdict in (Verdict.MISSING, Verdict.MISSING_IF_SIZE_MATTERS)
    assert found.groups_in_question[0] == group
