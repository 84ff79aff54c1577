"""The verdict on one effect."""

from types import SimpleNamespace

import pytest
from hasel_sysid.diagnosis.judgement import finding
from hasel_sysid.diagnosis.result import Verdict


def effect(name: str, largest: float = 10.0) -> SimpleNamespace:
    """An effect with one size, noticed at 1."""
    size = SimpleNamespace(name="size", unit="1", null=0.0, lower=0.0, upper=largest, typical=1.0, scan=())
    return SimpleNamespace(id=name, parameters=[size], source=None)


@pytest.fixture
def judged(context):
    """Verdict by effect when 0.01 of the sine is there; only the sine was fitted in full."""
    whole = context(0.01)
    for name in ("much_alike", "other", "swallowed"):
        del whole.finals[name]
    whole.finals["sine"].model.parameters = {"sine.size": SimpleNamespace(standard_error=0.1)}
    return lambda name, **keywords: finding(whole, effect(name, **keywords))


@pytest.fixture(autouse=True)
def _no_finer_numerics(monkeypatch):
    monkeypatch.setattr("hasel_sysid.diagnosis.judgement.with_numerical_error", lambda fit, changes: fit)


def test_the_best_plausible_fit_is_missing(judged):
    """With its value and standard error, and the share of the error that it removes."""
    found = judged("sine")
    assert found.verdict is Verdict.MISSING
    assert found.expected == {"sine.size": (0.5, 0.1)}
    assert found.error_removed > 0.9


def test_the_value_that_does_most_is_told(context):
    """Of a lag that rises at once and falls slowly the fall, in whatever order they stand."""
    whole = context(0.01)
    lag = effect("sine")
    fall = SimpleNamespace(name="fall", unit="s", null=0.0, lower=0.0, upper=9.0, typical=0.1, scan=())
    lag.parameters.append(fall)
    model = whole.finals["sine"].model
    model.values = {"sine.size": 1e-14, "sine.fall": 0.078}
    model.parameters = {name: SimpleNamespace(standard_error=0.01) for name in model.values}
    found = finding(whole, lag)
    assert found.leading == "sine.fall"
    assert "a size of 0.078 s removes" in str(found)


def test_what_would_have_shown_is_absent(judged):
    """A typical size of another shape stands far above the noise."""
    assert judged("other").verdict is Verdict.ABSENT


def test_what_the_winner_explains_accuses_no_other(judged):
    """Beside the winner nothing is left for its double."""
    assert judged("much_alike").verdict is Verdict.ABSENT
    assert judged("much_alike").error_removed > 0.9


def test_what_the_fitted_parameters_imitate_cannot_be_seen(judged):
    """However large it is."""
    found = judged("swallowed")
    assert found.verdict is Verdict.CANNOT_BE_SEEN
    assert found.swallowed == pytest.approx(1.0)


def test_what_shows_only_beyond_its_range_cannot_be_seen(judged):
    """An effect whose largest plausible size hides in the noise."""
    assert judged("other", largest=1e-6).verdict is Verdict.CANNOT_BE_SEEN
