"""A fit as the search sees it."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sysid.estimation import FittedModel
from hasel_sysid.selection.known_set import known_set
from hasel_sysid.testing.made_up_runs import made_up_evaluation

NAME, SERIES = "force_length.weakening", np.sin(np.linspace(0.0, 6.0, 50))


@pytest.mark.parametrize(("at_bound", "moving"), [((NAME,), 0), ((), 1)], ids=["on a bound", "inside"])
def test_a_set_is_on_edge_where_a_value_of_an_effect_ended_on_a_bound(at_bound, moving):
    """That value moves no more, and the set is still a plausible one."""
    model = load_model("swimmer").with_levels([4500.0]).with_effects("force_length").with_values({NAME: 1.0})
    evaluation = made_up_evaluation(
        np.zeros((1, 50)), np.arange(50) / 120, jacobian=SERIES[:, None], names=(NAME,), model=model
    )
    found = known_set(
        FittedModel(model, evaluation, at_bound, (), 1, "made up"),
        {"force_length": catalogue()["force_length"]},
    )
    assert found.on_edge == bool(at_bound)
    assert found.plausible
    assert found.jacobian.shape[1] == moving


@pytest.mark.parametrize(("undetermined", "answer"), [((), True), ((NAME,), False), (("slope",), True)])
def test_what_only_does_what_the_model_may_do_already_is_no_answer(undetermined, answer):
    """Such as a scale of the modulus beside a modulus that is free: the frames show their product alone."""
    model = load_model("swimmer").with_levels([4500.0]).with_effects("force_length").with_values({NAME: 0.5})
    evaluation = made_up_evaluation(
        np.zeros((1, 50)),
        np.arange(50) / 120,
        jacobian=np.column_stack([SERIES, SERIES]),
        names=(NAME, "slope"),
        model=model,
    )
    fit = FittedModel(model, evaluation, (), undetermined, 1, "made up")
    assert known_set(fit, {"force_length": catalogue()["force_length"]}).plausible == answer
