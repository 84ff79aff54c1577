"""The verdict on one effect."""

from dataclasses import replace

import pytest
from hasel_sim.effects.base import EffectParameter
from hasel_sysid.diagnosis.judgement import finding
from hasel_sysid.result import Verdict
from hasel_sysid.testing.made_up_effects import made_up_effect, made_up_size, with_made_up


@pytest.fixture
def judged(context):
    """Verdict by effect when 0.01 of the sine is there; only the sine was fitted in full."""
    every = context(0.01)
    whole = replace(every, finals={"sine": every.finals["sine"]})
    return lambda name, **keywords: finding(whole, made_up_effect(name, made_up_size(**keywords)))


def test_the_best_plausible_fit_is_missing(judged):
    """With its value and standard error, and the share of the error that it removes."""
    found = judged("sine")
    assert found.verdict is Verdict.MISSING
    assert found.expected == {"sine.size": (0.5, 0.1)}
    assert found.error_removed > 0.9


def test_the_value_that_does_most_is_told(context):
    """Of a lag that rises at once and falls slowly the fall, in whatever order they stand."""
    whole = context(0.01)
    fall = EffectParameter("fall", "t", "s", 0.0, 0.0, 9.0, 0.1)
    lag = made_up_effect("sine", made_up_size(), fall)
    final = whole.finals["sine"]
    values = {"sine.size": 1e-14, "sine.fall": 0.078}
    model = with_made_up(final.model.without_effects("sine"), lag)
    model = model.with_values(values, dict.fromkeys(values, 0.01))
    fitted = replace(final, model=model, evaluation=replace(final.evaluation, model=model))
    found = finding(replace(whole, finals={**whole.finals, "sine": fitted}), lag)
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
