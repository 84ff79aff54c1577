"""Steps of a trial."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model
from hasel_sysid.candidates import resized, starts, valued
from hasel_sysid.diagnosis.trial import Trials, _shortened
from hasel_sysid.problem import Problem
from hasel_sysid.testing.made_up_runs import made_up_trial


@pytest.fixture(scope="module")
def trials(bent_swimmer) -> Trials:
    """Of the bent swimmer."""
    return Trials(*bent_swimmer)


class WithoutDrafts(Problem):
    """Only what steps as finely as a given model can be simulated."""

    def __init__(self, of, model):
        super().__init__(of.experiments, of.pool)
        self._least = model.description.numerics.steps_per_second

    def evaluate(self, model, names=()):
        if model.description.numerics.steps_per_second < self._least:
            raise SimulationError("the motion could not be followed")
        return super().evaluate(model, names)


class OneAtATime(Problem):
    """Only models with a single effect can be simulated."""

    def __init__(self, of):
        super().__init__(of.experiments, of.pool)

    def evaluate_each(self, models, names):
        """Of several effects an error."""
        found = super().evaluate_each(models, names)
        several = [len(model.effects) > 1 for model in models]
        return [SimulationError("not finite") if s else f for s, f in zip(several, found, strict=True)]


def test_a_draft_that_cannot_be_simulated_gives_way_to_the_model(bent_swimmer):
    """Its steps are twice as long; what the model itself can follow is tried all the same."""
    problem, fitted = bent_swimmer
    trials = Trials(WithoutDrafts(problem, fitted.model), fitted)
    (trial,) = trials.first([starts(catalogue()["soft_modulus"])[0]])
    assert trials.base is fitted
    assert trial.residual == pytest.approx(fitted.residual, abs=1e-9)


def test_effects_without_effect_share_a_simulation(trials):
    """What signed effects promise does not depend on which others are tried beside them."""
    chosen = [starts(catalogue()[name])[0] for name in ("soft_modulus", "marker_offset", "pre_bend")]
    before = trials.problem.evaluations
    together = trials.first(chosen)
    assert trials.problem.evaluations == before + 1
    for start, trial in zip(chosen, together, strict=True):
        (alone,) = trials.first([start])
        assert trial.names == alone.names and trial.step == pytest.approx(alone.step, rel=1e-6)
        assert trial.predicted == pytest.approx(alone.predicted)
        assert [effect.id for effect in trial.model.effects] == [start.effect.id]


def test_one_sided_effects_share_a_simulation_where_they_do_nothing(trials):
    """What is left is to the last digit what the model leaves, and a drag's derivative leads to its change."""
    drag, lag = (starts(catalogue()[name])[0] for name in ("linear_drag", "charging_lag"))
    before = trials.problem.evaluations
    at_null = trials.first([drag.without_effect(), lag.without_effect()])
    assert trials.problem.evaluations == before + 1
    assert all((trial.residual == trials.fitted.residual).all() for trial in at_null)
    assert at_null[1].brought == ("charging_lag.charge_time", "charging_lag.discharge_time", "onset")
    (little,) = trials.first([resized(drag, 0.01)])
    slope = at_null[0].jacobian[:, at_null[0].is_brought][:, 0]
    change = trials.fitted.residual - little.residual
    expected = slope * little.start.values["linear_drag.rate"]
    assert np.linalg.norm(change - expected) < 0.02 * np.linalg.norm(change)


def test_a_time_of_what_does_nothing_changes_nothing(trials):
    """Not even by round-off, which looks like something once it is scaled; the time stays where it was."""
    for start in starts(catalogue()["slow_creep"]):
        (trial,) = trials.first([start.without_effect()])
        time = "slow_creep.relaxation_time"
        assert not trial.jacobian[:, trial.names.index(time)].any()
        assert trial.step[time] == start.values[time]


def test_what_cannot_be_simulated_beside_others_is_tried_alone(bent_swimmer):
    """As where the derivatives by one of them are not finite."""
    trials = Trials(OneAtATime(*bent_swimmer[:1]), bent_swimmer[1])
    chosen = [starts(catalogue()[name])[0] for name in ("soft_modulus", "pre_bend")]
    assert [trial.start for trial in trials.first(chosen)] == chosen


def test_one_step_moves_a_relaxation_time_by_half_of_it_at_most(trials):
    """Its derivative says nothing of a time ten times as long: a fit that starts there has lost what was promised."""
    for start in starts(catalogue()["charge_retention"]):
        (trial,) = trials.first([start])
        before, after = start.values["charge_retention.time"], trial.step["charge_retention.time"]
        assert 0.5 * before <= after <= 1.5 * before


def test_what_an_effect_makes_visible_comes_with_it(trials):
    """A lag brings its times and the muscles' onset, which is a parameter only where the drive sweeps."""
    (trial,) = trials.first(starts(catalogue()["charging_lag"]))
    assert trial.brought == ("charging_lag.charge_time", "charging_lag.discharge_time", "onset")
    assert trial.names == (*trials.fitted.names, *trial.brought)
    assert list(trial.is_brought) == [name in trial.brought for name in trial.names]


def test_half_a_step_promises_three_quarters_of_a_whole_one():
    """So it is for least squares, linear or not far from it: an effect that overshot once is not lost from sight."""
    jacobian, residual = np.array([[1.0], [1.0]]), np.array([3.0, 1.0])
    (whole,), *_ = np.linalg.lstsq(jacobian, residual, rcond=None)
    left = residual - jacobian[:, 0] * whole
    rate = "linear_drag.rate"
    start = valued(catalogue()["linear_drag"], {rate: 0.5})
    trial = made_up_trial(
        load_model("beam"), start, {rate: 0.5 + whole}, residual, jacobian, predicted=float(left @ left)
    )
    half = _shortened(trial)
    after = residual - jacobian[:, 0] * 0.5 * whole
    assert half.step == {rate: pytest.approx(0.5 + 0.5 * whole)}
    assert half.predicted == pytest.approx(after @ after)
