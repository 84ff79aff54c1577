"""Which explanations a run is to tell apart."""

import importlib
from types import SimpleNamespace

import pytest
from hasel_sim.errors import SimulationError
from hasel_sysid.errors import SysidError
from hasel_sysid.suggest import in_doubt, rivals

module = importlib.import_module("hasel_sysid.suggest.rivals")


def finding(effect, fitted=True):
    """A finding with or without a refitted model, of which only the name matters here."""
    return SimpleNamespace(effect=effect, fit=SimpleNamespace(model=f"with {effect}") if fitted else None)


def diagnosis(*findings, groups=()):
    """What a diagnosis found, most probable first."""
    baseline = SimpleNamespace(fit=SimpleNamespace(model="baseline"))
    return SimpleNamespace(findings=list(findings), groups=list(groups), context=baseline)


LAGS = diagnosis(finding("charging_lag"), finding("hydraulic_lag", False), finding("current_limit", False))


@pytest.fixture
def hopeless(monkeypatch):
    """Fits that are asked for succeed, but for these effects."""
    effects = set()

    def fitted(_problem, model, **_options):
        if model.split()[-1] in effects:
            raise SimulationError("too stiff to follow")
        return SimpleNamespace(model=model)

    monkeypatch.setattr(module, "fit_least_squares", fitted)
    monkeypatch.setattr(module, "with_effect", lambda model, found, effect: f"{model} and {effect}")
    return effects


def test_in_doubt_is_what_looks_like_the_accepted_effect():
    """Only refitted members of its group; with nothing accepted, all that were refitted."""
    found = diagnosis(
        finding("linear_drag"),
        finding("quadratic_drag"),
        finding("pre_bend"),
        finding("tether", False),
        groups=[("linear_drag", "quadratic_drag", "tether")],
    )
    assert set(in_doubt(found, ["quadratic_drag"])) == {"linear_drag", "quadratic_drag"}
    assert set(in_doubt(found, ["pre_bend"])) == set()
    assert set(in_doubt(found, [])) == {"linear_drag", "quadratic_drag", "pre_bend"}


def test_one_explanation_leaves_nothing_to_suggest():
    """A sentence says so, and how to ask all the same."""
    with pytest.raises(SysidError, match="fewer than two explanations"):
        rivals(None, LAGS)


def test_effects_that_were_named_are_compared_all_the_same(hopeless):
    """The one in the running with the next of the ranking, fitted for that."""
    assert rivals(None, LAGS, named=True) == {
        "charging_lag": "with charging_lag",
        "hydraulic_lag": "baseline and hydraulic_lag",
    }


def test_what_cannot_be_simulated_leaves_its_turn_to_the_next(hopeless):
    """And where nothing is left, that is said."""
    hopeless.add("hydraulic_lag")
    assert set(rivals(None, LAGS, named=True)) == {"charging_lag", "current_limit"}
    hopeless.add("current_limit")
    with pytest.raises(SysidError, match="fewer than two explanations"):
        rivals(None, LAGS, named=True)
