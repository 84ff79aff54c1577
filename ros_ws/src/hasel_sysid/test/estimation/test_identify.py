"""A fit as a user asks for it."""

import numpy as np
import pytest
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation import METHODS, FittedModel, identify
from hasel_sysid.testing.made_up_runs import made_up_evaluation

NAME = "current_limit.inverse_rate"


@pytest.fixture
def method(monkeypatch):
    """A method that moves nothing: it only tells how good a start is."""

    def install(squares):
        def stay(problem, model, progress):
            value = model.values[NAME]
            residual = np.array([np.sqrt(squares(value))])
            evaluation = made_up_evaluation(residual[None], np.zeros(1), names=(NAME,), model=model)
            at_bound = (NAME,) if value == 0 else ()
            return FittedModel(model, evaluation, at_bound, (), 1, "nothing")

        monkeypatch.setitem(METHODS, "least_squares", stay)

    return install


class Unsimulated:
    """A problem of which nothing can be simulated on finer numerics either."""

    @staticmethod
    def evaluate_each(models, names):
        """What comes of it, model by model."""
        return [SimulationError("too fine") for _ in models]


@pytest.fixture
def added():
    """The swimmer with an effect as `add` writes it."""
    return load_model("swimmer").with_levels([4500.0]).with_effects("current_limit")


def test_an_effect_that_sleeps_at_its_null_is_tried_from_its_typical_size(method, added):
    """The better of the two is kept."""
    method(lambda value: 1.0 if value == 0 else 0.2)
    assert identify(Unsimulated(), added, "least_squares").model.values[NAME] == pytest.approx(2e-5)


def test_an_effect_that_is_not_there_stays_out(method, added):
    """From its typical size it fits worse."""
    method(lambda value: 0.2 if value == 0 else 1.0)
    assert identify(Unsimulated(), added, "least_squares").model.values[NAME] == 0.0


def test_an_unknown_method_is_refused_with_the_nearest_name(added):
    """Before anything is simulated."""
    with pytest.raises(SysidError, match="least_squares"):
        identify(None, added, "least_square")
