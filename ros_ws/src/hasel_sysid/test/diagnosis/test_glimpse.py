"""What effects leave at some value, and which values are worth derivatives."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model
from hasel_sysid.candidates import Start, starts, valued
from hasel_sysid.diagnosis.glimpse import Glimpse, glimpses, worth_a_trial
from hasel_sysid.diagnosis.trial import Trials
from hasel_sysid.problem import Problem
from hasel_sysid.testing.made_up_runs import made_up_evaluation, made_up_trial

TIME = np.linspace(0.0, 9.0, 200)
DRAG, MASS = np.sin(TIME), np.cos(TIME)
IMITATED = np.sin(3 * TIME) / np.linalg.norm(np.sin(3 * TIME))
UNEXPLAINED = 2.0 * DRAG + 0.3 * MASS
MOTION = 5.0 * np.cos(5 * TIME)


class MadeUp:
    """Trials beside a model that imitates one shape and moves, in one run, otherwise than everything else here."""

    imitable = IMITATED[:, None]
    fitted = made_up_evaluation(UNEXPLAINED[None], TIME, simulated=MOTION)


class NoPayload(Problem):
    """Models with a payload cannot be simulated."""

    def __init__(self, of):
        super().__init__(of.experiments, of.pool)

    def evaluate_each(self, models, names):
        """An error in its place."""
        lost = ["payload" in [effect.id for effect in model.effects] for model in models]
        found = super().evaluate_each(models, names)
        return [SimulationError("lost") if gone else one for gone, one in zip(lost, found, strict=True)]


def drag(rate: float) -> Start:
    """Linear drag of this rate."""
    return valued(catalogue()["linear_drag"], {"linear_drag.rate": rate})


def seen(start: Start, change: np.ndarray) -> Glimpse:
    """Of a start that changes the series by so much."""
    return Glimpse(start, UNEXPLAINED - change)


def test_a_glimpse_leaves_what_a_trial_leaves(bent_swimmer):
    """It lacks the derivatives, and its simulation has none."""
    trials = Trials(*bent_swimmer)
    chosen = [starts(catalogue()[name])[0] for name in ("linear_drag", "strain_softening")]
    for glimpse, trial in zip(glimpses(trials, chosen), trials.first(chosen), strict=True):
        assert glimpse.start is trial.start
        assert glimpse.residual == pytest.approx(trial.residual, abs=1e-12)


def test_what_cannot_be_simulated_is_not_seen(bent_swimmer):
    """The others are."""
    trials = Trials(NoPayload(bent_swimmer[0]), bent_swimmer[1])
    chosen = [starts(catalogue()[name])[0] for name in ("payload", "linear_drag")]
    assert [glimpse.start for glimpse in glimpses(trials, chosen)] == chosen[1:]


def test_of_every_effect_the_size_that_comes_nearest_is_tried():
    """Not one that overshoots, though by its shape it could do as much; what the model imitates counts for nothing."""
    sizes = {0.1: 0.2 * DRAG, 1.0: 1.8 * DRAG + 50.0 * IMITATED, 10.0: 20.0 * DRAG}
    every = [seen(drag(rate), change) for rate, change in sizes.items()]
    assert worth_a_trial(every, [], MadeUp()) == [drag(1.0)]


@pytest.mark.parametrize("known, tried", [(1.9, []), (0.5, [drag(1.0)])])
def test_no_size_is_tried_where_a_trial_was_as_near(known, tried):
    """Its derivatives lead to the others."""
    jacobian = DRAG[:, None]
    made = made_up_trial(
        load_model("swimmer"), drag(0.3), {}, UNEXPLAINED - known * DRAG, jacobian, predicted=0.0
    )
    assert worth_a_trial([seen(drag(1.0), 1.8 * DRAG)], [made], MadeUp()) == tried


def test_what_comes_nearer_by_far_less_than_the_nearest_is_not_tried():
    """Whether that was seen only or tried."""
    mass = valued(catalogue()["added_mass"], {"added_mass.added_mass": 1.0})
    little, much = seen(mass, 0.3 * MASS), seen(drag(1.0), 1.5 * DRAG)
    assert worth_a_trial([little, much], [], MadeUp()) == [drag(1.0)]
    assert worth_a_trial([little], [], MadeUp()) == [mass]
    tried = made_up_trial(load_model("swimmer"), drag(1.0), {}, much.residual, DRAG[:, None], predicted=0.0)
    assert worth_a_trial([little], [tried], MadeUp()) == []


def test_a_motion_that_is_only_too_large_or_too_small_is_near():
    """Beside a model that is far off the muscles are as wrong: a drag that halves every motion may be right."""
    halved = Glimpse(drag(1.0), MadeUp.fitted.measured() - 0.5 * MadeUp.fitted.measured())
    nearer = seen(drag(10.0), 0.9 * DRAG)
    assert np.linalg.norm(halved.residual) > np.linalg.norm(nearer.residual)
    assert worth_a_trial([halved, nearer], [], MadeUp()) == [drag(1.0)]
