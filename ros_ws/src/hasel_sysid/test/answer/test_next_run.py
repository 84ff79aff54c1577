# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The library of experiments."""

import numpy as np
import pytest
from hasel_interfaces.action import RunExperiment
from hasel_recording import DriveChannel
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, load_model
from hasel_sim.parallel import executor
from hasel_sim.simulate import simulate
from hasel_sysid.answer.diagnosis import Diagnosis, Finding, Verdict
from hasel_sysid.answer.next_run import Manoeuvre, in_doubt, manoeuvres, rivals, suggest
from hasel_sysid.errors import SysidError
from hasel_sysid.noise import NoiseModel
from hasel_sysid.testing.made_up_runs import made_up_fit


def test_goals_fit_the_action():
    """Every field of a goal is one of the action's, and takes the value."""
    goal = RunExperiment.Goal(**Manoeuvre(4500.0, 2.0, 3, "triangle", "upper").goal())
    assert (goal.voltage, goal.frequency, goal.periods, goal.waveform) == (4500.0, 2.0, 3, "triangle")


def test_no_voltage_exceeds_the_safe_maximum():
    """Neither by choice nor at the peak of a waveform."""
    library = manoeuvres(np.array([3500.0, 4500.0, 5500.0]), 4600.0)
    assert library
    assert max(np.abs(m.run().schedule.signal).max() for m in library) <= 4600.0


@pytest.mark.parametrize("waveform", ["box", "triangle", "sine"])
def test_muscles_take_turns(waveform):
    """The two muscles are never driven together, and each gets the whole voltage once a period."""
    voltage = Manoeuvre(5000.0, 1.0, 2, waveform, "both").run().schedule.signal
    assert not np.any((voltage[:, 0] > 0) & (voltage[:, 1] > 0))
    assert voltage.max(axis=0) == pytest.approx([5000.0, 5000.0], rel=0.02)


def test_single_muscle_leaves_the_other_grounded():
    """Only the upper muscle sees a voltage."""
    voltage = Manoeuvre(5000.0, 1.0, 2, "box", "upper").run().schedule.signal
    assert voltage[:, 0].max() == 5000.0
    assert not voltage[:, 1].any()


def test_passive_bodies_are_held_and_let_go():
    """Without muscles the load under which the body is held is what can be chosen."""
    library = manoeuvres(np.zeros(0), 5500.0)
    assert {m.run().initial_state for m in library} == {"static_equilibrium"}
    assert len({m.load_factor for m in library}) == len(library)


def test_other_channels_are_driven_in_their_own_unit():
    """A chamber is filled for half the period; three channels take turns; both are said in their unit."""
    chamber = (DriveChannel("chamber", "pressure", "Pa"),)
    library = manoeuvres(np.array([10000.0, 25000.0]), 25000.0, channels=chamber)
    assert {m.muscles for m in library} == {"both"}
    one = Manoeuvre(25000.0, 1.0, 2, "box", "both", channels=chamber)
    assert one.run().schedule.signal[:, 0].tolist() == [25000.0, 0.0, 25000.0, 0.0]
    assert str(one) == "box of 25000 Pa at 1 Hz, 2 periods, chamber only"
    assert one.goal()["channels"] == ["pressure_chamber_pa"]
    three = tuple(DriveChannel(name, "voltage", "V") for name in ("root", "middle", "tip"))
    for waveform in ("box", "triangle"):
        signal = Manoeuvre(5000.0, 1.0, 2, waveform, "both", channels=three).run().schedule.signal
        assert np.count_nonzero(signal, axis=1).max() == 1
        assert signal.max(axis=0) == pytest.approx([5000.0] * 3, rel=0.05)


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


NOISE = NoiseModel(white=9e-6, coloured=0.0, correlation=0.5)


@pytest.fixture(scope="module")
def delayed_or_not():
    """Two models that a slow drive hardly tells apart."""
    model = load_model("swimmer").with_levels(np.array([3500.0, 5500.0]))
    model = model.with_values({"amplitude_3500": 0.027, "amplitude_5500": 0.062, "slope": 0.26})
    return {
        "transport_delay": model.with_effects("transport_delay").with_values({"transport_delay.delay": 0.03}),
        "none": model,
    }


def test_the_best_run_separates_them_most(delayed_or_not):
    """Ranked by the difference, within the safe maximum, and a full simulation confirms what the draft promises."""
    with executor(1) as pool:
        ranked = suggest(pool, delayed_or_not, NOISE, 5500.0, brief=True)
    differences = [suggestion.difference for suggestion in ranked]
    assert differences == sorted(differences, reverse=True)
    best = ranked[0]
    assert best.manoeuvre.voltage == 5500.0
    one, other = (simulate(model, best.manoeuvre.run()).sin_theta for model in delayed_or_not.values())
    assert best.difference == pytest.approx(np.std(one - other) / NOISE.standard_deviation, rel=0.2)
    assert best.to_json()["pairs"][0]["difference"] == best.difference
