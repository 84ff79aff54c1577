"""Sets of effects of the simulator."""

import pytest
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sysid.estimation.least_squares import fitted_result
from hasel_sysid.selection.simulated_sets import SimulatedSets

IMPOSSIBLE = '''
"""A muscle that cannot be simulated."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class Impossible(DriveEffect):
    """A contraction that no body survives."""

    id = "impossible"
    physics = "None: it is here to fail."
    equation = "e <- (1 + 20 000 a) e"
    parameters = (EffectParameter("amount", "a", "1", 0.0, 0.0, 1.0, 0.5, "a test"),)
    signature = "None."
    confused_with = ()
    separated_by = "Nothing."
    citation = "None"
    stage = DriveStage.CONTRACTION

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Ten thousand times as much."""
        return signal * (1.0 + 2e4 * p.amount)
'''


@pytest.fixture
def look(tmp_path, bent_swimmer):
    """What effects could do beside the bent swimmer."""
    (tmp_path / "impossible.py").write_text(IMPOSSIBLE)
    problem, evaluation = bent_swimmer
    fit = fitted_result(evaluation, 1)
    (impossible,) = find_effects((f"{tmp_path / 'impossible.py'}:Impossible",))

    def prospects(*others: str) -> set[str]:
        sets = SimulatedSets(problem, fit, [impossible, *(catalogue()[name] for name in others)])
        found = sets.prospects(sets.baseline(), None, lambda p: -float(p.residual @ p.residual), 4)
        assert "impossible" in sets.tried
        return set(found)

    return prospects


def test_a_look_at_which_nothing_can_be_simulated_finds_nothing(look):
    """It counts as tried, and is no error."""
    assert look() == set()


def test_what_cannot_be_simulated_does_not_take_the_others_with_it(look):
    """The others are found as without it."""
    assert look("pre_bend") == {"pre_bend"}
