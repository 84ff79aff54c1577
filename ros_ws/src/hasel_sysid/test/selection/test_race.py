"""Racing of single candidates on the low-fidelity model."""

import pytest
from hasel_sysid.candidates import effects_of
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.problem import LowFidelityProblem
from hasel_sysid.selection.likelihood import Likelihood
from hasel_sysid.selection.race import race, screen_typical
from hasel_sysid.testing.made_up_world import NOISE, MadeUpWorld

SOME = ("payload", "pre_bend", "linear_drag", "viscoelastic_creep", "tether")


@pytest.mark.parametrize(
    ("hidden", "values"),
    [
        ("payload", {"payload.mass": 0.13}),
        ("pre_bend", {"pre_bend.curvature": -0.3}),
        ("viscoelastic_creep", {"viscoelastic_creep.relaxation_time": 1.6}),
    ],
    ids=["ten times the typical size", "the other sign", "another time"],
)
def test_what_is_hidden_wins_with_its_value(hidden, values):
    """From standard starts, whatever its size, sign or time: it ends at the noise, and no other comes near."""
    world = MadeUpWorld(3)
    problem = world.measured(world.with_typical(hidden).with_values(values))
    low = LowFidelityProblem(problem, fit_baseline(problem, world.model).evaluation)
    likelihood = Likelihood(NoiseModel(NOISE**2, 0.0, 0.5), low.known.runs)
    screened, untried = screen_typical(low, effects_of(world.model, SOME))
    assert untried == []
    ended = race(low, screened, likelihood, reach=8.0)
    best = min(ended, key=lambda name: ended[name].sum_of_squares)
    assert best == hidden
    assert ended[best].sum_of_squares == pytest.approx(NOISE**2 * len(low.known.residual), rel=0.1)
    for name, value in values.items():
        assert ended[best].model.values[name] == pytest.approx(value, rel=0.1)
    assert all(ended[name].sum_of_squares > 2 * ended[best].sum_of_squares for name in ended if name != best)


def test_beside_no_time_the_first_candidates_are_screened_all_the_same():
    """Eight of them; the others are listed as untried."""
    world = MadeUpWorld(3)
    problem = world.measured(world.with_typical("payload"), most_evaluations=0)
    low = LowFidelityProblem(problem, fit_baseline(problem, world.model).evaluation)
    every = effects_of(world.model)
    screened, untried = screen_typical(low, every)
    tried = {one.start.candidate.name for one in screened}
    assert len(tried) == 8
    assert {c.name for c in untried} == {c.name for c in every} - tried
