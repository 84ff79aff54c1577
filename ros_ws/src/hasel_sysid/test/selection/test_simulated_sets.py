"""Sets of effects of the simulator."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.model import Model, load_model
from hasel_sysid.estimation import FittedModel, fit_least_squares
from hasel_sysid.estimation.least_squares import fitted_result
from hasel_sysid.problem import Problem
from hasel_sysid.selection.simulated_sets import SimulatedSets
from hasel_sysid.testing.made_up_world import MadeUpWorld
from hasel_sysid.testing.simulated_runs import simulated_runs

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


def _swimmer(*effects: str) -> Model:
    """On a coarse mesh, with amplitudes for two voltages."""
    model = load_model("swimmer").with_levels([3500.0, 5500.0]).with_effects(*effects)
    return model.with_numerics(mesh_density=0.5, quadrature_order=2, steps_per_second=120.0)


@pytest.fixture(scope="module")
def heavy_in_water() -> Problem:
    """Two runs of a swimmer that drags six times the usual added mass along."""
    values = {"amplitude_3500": 0.03, "amplitude_5500": 0.05, "added_mass.added_mass": 3.0}
    drives = (3500.0, 1.0), (5500.0, 2.0)
    return simulated_runs(_swimmer("added_mass").with_values(values), drives, np.arange(0.0, 1.5, 1 / 60))


def _known(problem: Problem, model: Model) -> FittedModel:
    return fitted_result(problem.evaluate(model, model.free), 1)


def test_beside_a_fit_that_is_far_off_an_effect_is_found_over_decades_and_from_the_given_values(
    heavy_in_water,
):
    """Its amplitudes say how much the body moved, and not how the muscles pulled: no derivative points home from there,
    nor from the effect's typical size.
    """
    far_off = _known(
        heavy_in_water, _swimmer().with_values({"amplitude_3500": 0.036, "amplitude_5500": 0.009})
    )

    def fitted(given: Model | None) -> FittedModel:
        sets = SimulatedSets(heavy_in_water, far_off, [catalogue()["added_mass"]], given=given)
        seen = sets.prospects(sets.baseline(), None, lambda p: -float(p.residual @ p.residual), 4)
        return sets.fit(frozenset({"added_mass"}), sets.baseline(), seen.values()).fit

    assert fitted(None).evaluation.mean_absolute_error > 0.05
    assert fitted(_swimmer()).model.values["added_mass.added_mass"] == pytest.approx(3.0, rel=1e-3)


def test_an_amplitude_that_no_muscle_has_the_time_to_reach_is_given_again(heavy_in_water):
    """The slope makes up for it, the fit comes close, and no derivative leads back. From the given values it does, into
    a valley so flat that a thousandth of the start moves its end by a tenth: the value's own error says how well.
    """
    values = {"amplitude_5500": 0.5, "slope": 0.25, "added_mass.added_mass": 3.0}
    astray = _known(heavy_in_water, _swimmer("added_mass").with_values({"amplitude_3500": 0.03, **values}))

    def fitted(given: Model | None) -> FittedModel:
        sets = SimulatedSets(heavy_in_water, astray, [catalogue()["added_mass"]], given=given)
        return sets.fit(frozenset({"added_mass"}), sets.baseline(), ()).fit

    lost, again = fitted(None), fitted(_swimmer())
    amplitude = again.model.parameters["amplitude_5500"]
    assert "amplitude_5500" in lost.undetermined
    assert amplitude.standard_error < 0.005
    assert amplitude.value == pytest.approx(0.05, abs=2 * amplitude.standard_error)
    assert again.evaluation.sum_of_squares < 0.5 * lost.evaluation.sum_of_squares


def test_a_fit_is_held_against_the_best_set_that_was_fitted(heavy_in_water):
    """What would never come near it is broken off; alone, the same goes on to its end."""
    far_off = _known(
        heavy_in_water, _swimmer().with_values({"amplitude_3500": 0.036, "amplitude_5500": 0.009})
    )
    lag, heavy = frozenset({"charging_lag"}), frozenset({"added_mass"})

    def fitted_after(*before: frozenset[str]) -> FittedModel:
        effects = [catalogue()[name] for name in ("charging_lag", "added_mass")]
        sets = SimulatedSets(heavy_in_water, far_off, effects, given=_swimmer())
        seen = sets.prospects(sets.baseline(), None, lambda p: -float(p.residual @ p.residual), 4)
        for one in (*before, lag):
            (effect,) = one
            found = sets.fit(one, sets.baseline(), [seen[effect]])
        return found.fit

    alone, after = fitted_after(), fitted_after(heavy)
    assert not after.converged
    assert after.iterations < alone.iterations


def test_two_effects_of_the_drive_that_both_bring_the_onset_are_fitted_together(heavy_in_water):
    """Each looks better with an onset of the muscles, which the model without them does not have."""
    effects = [catalogue()[name] for name in ("charging_lag", "current_limit")]
    baseline = _known(
        heavy_in_water, _swimmer().with_values({"amplitude_3500": 0.03, "amplitude_5500": 0.05})
    )
    sets = SimulatedSets(heavy_in_water, baseline, effects)
    seen = sets.prospects(sets.baseline(), None, lambda p: -float(p.residual @ p.residual), 4)
    assert all("onset" in prospect.start.step for prospect in seen.values())
    both = sets.fit(frozenset(seen), sets.baseline(), list(seen.values()))
    assert both.effects == {"charging_lag", "current_limit"}
    assert "onset" in both.fit.model.values and "onset" not in baseline.model.values


def test_beside_a_set_what_starts_without_effect_is_looked_at_there(heavy_in_water):
    """Whatever size of it looked best beside the baseline, where sizes over its range were tried."""
    constants = [catalogue()[name] for name in ("soft_modulus", "spine_modulus")]
    amplitudes = {"amplitude_3500": 0.03, "amplitude_5500": 0.05}
    baseline = _known(heavy_in_water, _swimmer().with_values(amplitudes))
    softer = _swimmer("spine_modulus").with_values({**amplitudes, "spine_modulus.scale": 0.5})
    effects = [*constants, catalogue()["added_mass"]]
    sets = SimulatedSets(heavy_in_water, baseline, effects, given=_swimmer())
    assert set(sets.at_null) == {"soft_modulus", "spine_modulus"}

    def nearest_to_null(prospect) -> float:
        return -abs(prospect.start.model.values["soft_modulus.scale"] - 1.0)

    sets.prospects(sets.baseline(), None, lambda p: -float(p.residual @ p.residual), 0)
    beside = sets.known_as(_known(heavy_in_water, softer))
    seen = sets.prospects(beside, ["soft_modulus"], nearest_to_null, 0)
    assert nearest_to_null(seen["soft_modulus"]) == 0.0


class Hiding(MadeUpWorld):
    """A world in which a drag does nothing up to a third of its typical size beside another effect."""

    def sin_theta_at(self, effects, values):
        """The angle of every run."""
        if {"linear_drag", "pre_bend"} <= {effect.id for effect in effects}:
            typical = catalogue()["linear_drag"].parameters[0].typical
            size = max(0.0, values["linear_drag.rate"] / typical - 0.3) / 0.7
            values = {**values, "linear_drag.rate": typical * size}
        return super().sin_theta_at(effects, values)


def test_what_is_hidden_where_it_does_nothing_is_looked_at_at_its_expected_size_beside_a_set():
    """Beside the baseline its derivative shows there; beside the other effect it takes most of what is left away."""
    world = Hiding(1)
    problem = world.measured(world.with_typical("pre_bend", "linear_drag"))
    fit = fit_least_squares(problem, world.model)
    sets = SimulatedSets(problem, fit, [catalogue()[name] for name in ("pre_bend", "linear_drag")])
    seen = sets.prospects(sets.baseline(), None, lambda p: -float(p.residual @ p.residual), 4)
    bent = sets.fit(frozenset({"pre_bend"}), sets.baseline(), [seen["pre_bend"]])
    drag = sets.prospects(bent, ["linear_drag"], lambda p: -float(p.residual @ p.residual), 0)["linear_drag"]
    assert float(drag.least_residual @ drag.least_residual) < 0.5 * bent.squares
