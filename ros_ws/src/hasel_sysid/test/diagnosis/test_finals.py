"""Which effects are fitted in full."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sysid.diagnosis import finals as module
from hasel_sysid.diagnosis.finals import full_fits
from hasel_sysid.time_limit import TimeLimit

SQUARES = {"best": 0.4, "its_double": 0.5, "stuck": 0.6, "never": 0.9}
"""What the trials promise of a sum of squares of 1; the full fit of the one that got stuck leaves only noise."""
LEFT = {"best": 0.4, "its_double": 0.4, "stuck": 0.1, "never": 0.9}


UNHURRIED = SimpleNamespace(time_limit=TimeLimit())


class Model:
    """One effect at most."""

    def __init__(self, *names):
        self.effects = [
            SimpleNamespace(id=n, exclusive="same" if n in ("best", "its_double") else "") for n in names
        ]

    def with_effects(self, name):
        """Of that name."""
        return Model(name)

    def with_values(self, values):
        """Values do not matter here."""
        return self


def trial(name, predicted=None):
    """A trial that promises what `SQUARES` says, if nothing else."""
    effect = Model(name).effects[0]
    effect.source = None
    return SimpleNamespace(
        start=SimpleNamespace(effect=effect), predicted=predicted or SQUARES[name], promised=0.5, step={}
    )


def none_larger(worth):
    """For a test in which nothing may start from a larger size."""
    raise AssertionError("asked for larger sizes although the error is explained")


def result(model, squares):
    """A fit that leaves this sum of squares."""
    evaluation = SimpleNamespace(sum_of_squares=squares, jacobian=np.zeros((4, 0)), runs=np.zeros(4, int))
    return SimpleNamespace(model=model, evaluation=evaluation, iterations=3)


@pytest.fixture(autouse=True)
def _fits(monkeypatch):
    left = {name: iter([squares, 0.1, 0.1]) for name, squares in LEFT.items()}
    monkeypatch.setattr(
        module,
        "fit_least_squares",
        lambda problem, model, **how: result(model, next(left[model.effects[0].id])),
    )
    monkeypatch.setattr(module, "noise_of", lambda problem, fit, finals: None)
    monkeypatch.setattr(module, "allowed_noise", lambda problem, noise: None)
    monkeypatch.setattr(module, "expected_squares", lambda *of: 0.1)
    monkeypatch.setattr(module, "plausible", lambda finals, fit: finals)


def test_what_only_got_stuck_is_fitted_where_the_best_explains_too_little():
    """Its double, which does the same, is passed over for it; what promises next to nothing is left alone."""
    found = full_fits(UNHURRIED, result(Model(), 1.0), [trial(name) for name in SQUARES], none_larger, None)
    assert list(found) == ["best", "stuck"]


def test_what_could_not_remove_enough_to_be_accepted_is_not_fitted():
    """A quarter of the error above the noise by its next step, but by all its derivatives no more than that."""
    weak = trial("stuck", 0.75)
    weak.promised = 0.26
    found = full_fits(UNHURRIED, result(Model(), 1.0), [trial("best"), weak], lambda worth: [], None)
    assert list(found) == ["best"]
    weak.promised = 0.28
    found = full_fits(UNHURRIED, result(Model(), 1.0), [trial("never"), weak], lambda worth: [], None)
    assert list(found) == ["never", "stuck"]


def test_once_the_error_is_explained_no_other_is_fitted():
    """The best one leaves only noise."""
    found = full_fits(UNHURRIED, result(Model(), 1.0), [trial("stuck"), trial("never")], none_larger, None)
    assert list(found) == ["stuck"]


def test_an_effect_is_fitted_again_from_a_larger_size():
    """Where nothing explains the error: from there it leaves only noise, which takes the place of its first fit."""
    found = full_fits(
        UNHURRIED, result(Model(), 1.0), [trial("best")], lambda worth: [trial("best", 0.05)], None
    )
    assert {name: final.evaluation.sum_of_squares for name, final in found.items()} == {"best": 0.1}


def test_a_larger_size_that_promises_no_more_is_left_alone():
    """What its full fit has reached already is not fitted again."""
    found = full_fits(
        UNHURRIED, result(Model(), 1.0), [trial("best")], lambda worth: [trial("best", 0.45)], None
    )
    assert found["best"].evaluation.sum_of_squares == 0.4


def test_a_worse_fit_does_not_take_the_place_of_a_better_one(monkeypatch):
    """Whatever a larger size promised."""
    squares = iter([0.4, 0.7])
    monkeypatch.setattr(
        module, "fit_least_squares", lambda problem, model, **how: result(model, next(squares))
    )
    found = full_fits(
        UNHURRIED, result(Model(), 1.0), [trial("best")], lambda worth: [trial("best", 0.05)], None
    )
    assert found["best"].evaluation.sum_of_squares == 0.4


def test_near_the_noise_no_larger_size_is_tried(monkeypatch):
    """What a small effect leaves may be a large share of little."""
    monkeypatch.setattr(module, "expected_squares", lambda *of: 0.32)
    assert list(full_fits(UNHURRIED, result(Model(), 1.0), [trial("best")], none_larger, None)) == ["best"]


def test_a_larger_size_must_promise_nearly_what_the_best_fit_does():
    """The best removes 0.6 of the sum of squares."""
    asked = []
    full_fits(UNHURRIED, result(Model(), 1.0), [trial("best")], lambda worth: asked.append(worth) or [], None)
    assert asked == [pytest.approx(0.9 * 0.6)]


def test_what_runs_left_out_refute_leaves_the_next_its_turn(monkeypatch):
    """The best explains all but is not plausible."""
    monkeypatch.setattr(
        module, "plausible", lambda finals, fit: {n: f for n, f in finals.items() if n != "stuck"}
    )
    trials = [trial("stuck"), trial("best")]
    found = full_fits(UNHURRIED, result(Model(), 1.0), trials, lambda worth: [], None)
    assert list(found) == ["stuck", "best"]


@pytest.mark.parametrize(("promised", "fitted"), [(0.82, ["stuck", "best"]), (0.8, ["stuck"])])
def test_what_stays_above_the_noise_stands_beside_what_promises_as_much(monkeypatch, promised, fitted):
    """The best removes 0.9 of 0.95 above the noise, but leaves twice the noise: larger sizes are tried, too."""
    monkeypatch.setattr(module, "expected_squares", lambda *of: 0.05)
    rival = trial("best", 0.7)
    rival.promised = promised
    asked = []
    found = full_fits(
        UNHURRIED,
        result(Model(), 1.0),
        [trial("stuck"), rival],
        lambda worth: asked.append(worth) or [],
        None,
    )
    assert list(found) == fitted
    assert asked == [pytest.approx(0.9 * 0.9)]


def test_the_best_and_what_comes_close_to_it_are_fitted_to_the_end(monkeypatch):
    """Broken off after eight evaluations; what is further behind stays as it is."""
    ends = {"best": iter([0.4, 0.39]), "stuck": iter([0.405, 0.38]), "never": iter([0.5])}

    def fitted(problem, model, **how):
        brief = result(model, next(ends[model.effects[0].id]))
        return SimpleNamespace(**{**vars(brief), "iterations": how.get("most_evaluations", 12)})

    monkeypatch.setattr(module, "fit_least_squares", fitted)
    trials = [trial(name, 0.4) for name in ends]
    found = full_fits(UNHURRIED, result(Model(), 1.0), trials, lambda worth: [], None)
    assert {name: final.evaluation.sum_of_squares for name, final in found.items()} == {
        "best": 0.39,
        "stuck": 0.38,
        "never": 0.5,
    }
