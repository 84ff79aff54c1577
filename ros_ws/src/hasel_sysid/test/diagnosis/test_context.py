"""What a verdict rests on."""

import numpy as np
import pytest
from hasel_sim.model import load_model
from hasel_sysid.diagnosis.context import on_edge, out_of_range
from hasel_sysid.estimation import FittedModel
from hasel_sysid.testing.made_up_runs import made_up_evaluation

NAME, ERROR = "force_length.weakening", 0.03


def ended(value: float, pull: float, at_bound: bool = True, undetermined: bool = False) -> FittedModel:
    """A fit that left the weakening at a value, while the runs ask for so much more of it."""
    model = load_model("swimmer").with_levels([4500.0]).with_effects("force_length")
    model = model.with_values({NAME: value}, {NAME: None if undetermined else ERROR})
    series = np.sin(np.linspace(0.0, 6.0, 50))
    evaluation = made_up_evaluation(
        (pull * series)[None], np.arange(50) / 120, jacobian=series[:, None], names=(NAME,), model=model
    )
    return FittedModel(
        model, evaluation, (NAME,) if at_bound else (), (NAME,) if undetermined else (), 1, "made up"
    )


@pytest.mark.parametrize(
    ("value", "pull", "out"),
    [(1.0, 0.5 * ERROR, False), (1.0, 3 * ERROR, True), (1.0, 0.0, False), (0.0, -3 * ERROR, False)],
    ids=["beyond by noise", "surely beyond", "at its end", "not there"],
)
def test_a_value_at_the_end_of_its_range_is_out_of_it_only_beyond_noise(value, pull, out):
    """What is hidden may lie at the end; an effect at its null is not there, whatever it would take."""
    assert out_of_range("force_length", ended(value, pull)) == out


@pytest.mark.parametrize(
    ("value", "options", "found"),
    [(1.0, {}, [NAME]), (1.0, {"undetermined": True}, []), (0.5, {"at_bound": False}, []), (0.0, {}, [])],
    ids=["at its end", "not shown", "inside", "not there"],
)
def test_a_value_is_on_the_edge_of_its_range_where_it_ended_there(value, options, found):
    """However little it would go on from there; what is not there, or not shown, is on no edge."""
    assert on_edge("force_length", ended(value, 0.0, **options)) == found


def test_what_nothing_shows_and_what_no_bound_holds_is_in_range():
    """Neither says anything against the effect."""
    far = 10 * ERROR
    assert not out_of_range("force_length", ended(1.0, far, undetermined=True))
    assert not out_of_range("force_length", ended(0.5, far, at_bound=False))
