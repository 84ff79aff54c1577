"""What scipy's least squares asks of a model."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.estimation.asked import AskedModel, EnoughError
from hasel_sysid.testing.made_up_runs import made_up_evaluation

NAME, TIME = "material_damping.retardation_time", np.linspace(0.0, 6.2, 400)
LEFT = np.sin(TIME)


class Stepped:
    """Runs in which a step takes away a thousandth of the squares, and promised so many times as much."""

    def __init__(self, promise: float):
        self.promise = promise

    def evaluate(self, model, names):
        """As of a problem's, at the model's values."""
        time, slope = model.values[NAME], 0.005 * self.promise
        residual = (1.0 - 0.005 * time) * LEFT
        motion = 10 * np.sin(3 * TIME)
        return made_up_evaluation(residual[None], TIME, None, motion, slope * LEFT[:, None], names, model)


def _steps(promise: float) -> None:
    model = load_model("beam").with_effects("material_damping")
    asked = AskedModel(Stepped(promise), model, (NAME,), np.ones(1), None, 25, rough=1e-4)
    asked.begin(np.array([0.0]))
    asked.jacobian(np.array([0.0]))
    asked.jacobian(np.array([0.1]))


def test_a_step_that_gives_little_and_keeps_its_promise_is_the_last():
    """The next would give no more."""
    with pytest.raises(EnoughError):
        _steps(promise=1.0)


def test_a_step_that_gives_little_of_what_it_promised_is_not_the_last():
    """It was held back, and a shorter one may give more."""
    _steps(promise=10.0)
