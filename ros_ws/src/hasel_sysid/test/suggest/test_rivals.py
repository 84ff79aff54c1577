"""Which explanations a run is to tell apart."""

import pytest
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, load_model
from hasel_sysid.diagnosis import Diagnosis, Finding, Verdict
from hasel_sysid.errors import SysidError
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.suggest import in_doubt, rivals
from hasel_sysid.testing.made_up_runs import made_up_fit


@pytest.fixture(scope="module")
def swimmer() -> Model:
    """At one voltage."""
    return load_model("swimmer").with_levels([4500.0])


@pytest.fixture
def diagnosis(swimmer):
    """Make what a diagnosis found, most probable first: effects with a refitted model (True), and those without."""

    def make(effects: dict[str, bool], groups=()) -> Diagnosis:
        findings = [
            Finding(
                *(effect, Verdict.MISSING, 0.5, 0.5, {}, {}, 0.0, 0.0),
                fit=made_up_fit(swimmer.with_effects(effect), 0.01) if fitted else None,
            )
            for effect, fitted in effects.items()
        ]
        noise, fit = NoiseModel(9e-6, 0.0, 0.5, "a test"), made_up_fit(swimmer, 0.02)
        return Diagnosis(findings, list(groups), noise, noise, 0.0, 0.98, 0.99, 0.02, {}, fit)

    return make


@pytest.fixture
def lags(diagnosis):
    """One is in the running."""
    return diagnosis({"charging_lag": True, "hydraulic_lag": False, "current_limit": False})


def fit_but(*hopeless):
    """A fit that leaves the model as it is, but for those with one of these effects."""

    def fit(model):
        if model.effects[-1].id in hopeless:
            raise SimulationError("too stiff to follow")
        return model

    return fit


def test_in_doubt_is_what_looks_like_the_accepted_effect(diagnosis):
    """Only refitted members of its group; with nothing accepted, all that were refitted."""
    found = diagnosis(
        {"linear_drag": True, "quadratic_drag": True, "pre_bend": True, "tether": False},
        groups=[("linear_drag", "quadratic_drag", "tether")],
    )
    assert set(in_doubt(found, ["quadratic_drag"])) == {"linear_drag", "quadratic_drag"}
    assert set(in_doubt(found, ["pre_bend"])) == set()
    assert set(in_doubt(found, [])) == {"linear_drag", "quadratic_drag", "pre_bend"}


def test_one_explanation_leaves_nothing_to_suggest(lags):
    """A sentence says so, and how to ask all the same."""
    with pytest.raises(SysidError, match="fewer than two explanations"):
        rivals(lags)


def test_effects_that_were_named_are_compared_all_the_same(lags):
    """The one in the running with the next of the ranking, fitted for that from its typical size."""
    found = rivals(lags, fit_but())
    assert list(found) == ["charging_lag", "hydraulic_lag"]
    next_one = found["hydraulic_lag"]
    assert [effect.id for effect in next_one.effects] == ["hydraulic_lag"]
    typical = next_one.effects[0].typical()
    assert {name: next_one.values[f"hydraulic_lag.{name}"] for name in typical} == typical


def test_what_cannot_be_simulated_leaves_its_turn_to_the_next(lags):
    """And where nothing is left, that is said."""
    assert set(rivals(lags, fit_but("hydraulic_lag"))) == {"charging_lag", "current_limit"}
    with pytest.raises(SysidError, match="fewer than two explanations"):
        rivals(lags, fit_but("hydraulic_lag", "current_limit"))
