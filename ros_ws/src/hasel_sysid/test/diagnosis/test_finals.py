"""Which effects are fitted in full."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sysid.diagnosis import finals as module
from hasel_sysid.diagnosis.finals import full_fits

SQUARES = {"best": 0.4, "its_double": 0.5, "stuck": 0.6, "never": 0.9}
"""What the trials promise of a sum of squares of 1; the full fit of the one that got stuck leaves only noise."""


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


def trial(name):
    """A trial that promises what `SQUARES` says."""
    effect = Model(name).effects[0]
    effect.source = None
    return SimpleNamespace(
        start=SimpleNamespace(effect=effect), predicted=SQUARES[name], promised=0.5, step={}
    )


def result(model, squares):
    """A fit that leaves this sum of squares."""
    evaluation = SimpleNamespace(sum_of_squares=squares, jacobian=np.zeros((4, 0)), runs=np.zeros(4, int))
    return SimpleNamespace(model=model, evaluation=evaluation, iterations=3)


@pytest.fixture(autouse=True)
def _fits(monkeypatch):
    left = {"best": 0.4, "its_double": 0.4, "stuck": 0.1, "never": 0.9}
    monkeypatch.setattr(
        module, "fit_least_squares", lambda problem, model, **how: result(model, left[model.effects[0].id])
    )
    monkeypatch.setattr(module, "noise_beyond", lambda fit, finals: None)
    monkeypatch.setattr(module, "expected_squares", lambda *of: 0.1)
    monkeypatch.setattr(module, "plausible", lambda finals: finals)


def test_what_only_got_stuck_is_fitted_where_the_best_explains_too_little():
    """Its double, which does the same, is passed over for it; what promises next to nothing is left alone."""
    found = full_fits(None, result(Model(), 1.0), [trial(name) for name in SQUARES], None)
    assert list(found) == ["best", "stuck"]


def test_once_the_error_is_explained_no_other_is_fitted():
    """The best one leaves only noise."""
    found = full_fits(None, result(Model(), 1.0), [trial("stuck"), trial("never")], None)
    assert list(found) == ["stuck"]
