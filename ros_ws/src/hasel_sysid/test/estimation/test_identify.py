# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A fit as a user asks for it."""

import numpy as np
import pytest
from hasel_sim.model import Model, load_model
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation import identify
from hasel_sysid.testing.made_up_runs import FormulaProblem

NAME, MASS = "material_damping.retardation_time", "payload.mass"
TIME = np.arange(0.0, 2.0, 0.01)


def sleeping(model: Model, time: np.ndarray) -> np.ndarray:
    """A body that is let go; its damping does nothing below a millisecond. Steps of half the length move it faster."""
    finer = (
        model.description.numerics.steps_per_second > model_with(0.0).description.numerics.steps_per_second
    )
    rate = (1.001 if finer else 1.0) * 6 / np.sqrt(1 + model.values.get(MASS, 0.0))
    return 0.2 * np.exp(-40 * max(0.0, model.values.get(NAME, 0.0) - 1e-3) * time) * np.cos(rate * time)


def model_with(damping: float) -> Model:
    """The beam with a payload and with damping, as `add` writes them."""
    return load_model("beam").with_effects("payload", "material_damping").with_values({NAME: damping})


def measured(damping: float) -> FormulaProblem:
    """A swing with a payload of 0.2 kg/m and this damping."""
    noise = 0.001 * np.random.default_rng(0).standard_normal(len(TIME))
    truth = model_with(damping).with_values({MASS: 0.2})
    return FormulaProblem(sleeping, TIME, sleeping(truth, TIME) + noise)


@pytest.mark.parametrize("damping", [0.0, 0.02])
def test_an_effect_that_sleeps_at_its_null_is_tried_from_its_standard_starts(damping):
    """There no derivative shows it; one that is not there stays out."""
    found = identify(measured(damping), model_with(0.0))
    assert found.model.values[MASS] == pytest.approx(0.2, rel=0.02)
    assert max(1e-3, found.model.values[NAME]) == pytest.approx(max(1e-3, damping), rel=0.05)


def test_standard_errors_hold_the_discretisation():
    """What shorter time steps would move the mass by is one standard error more, far above that by noise here."""
    found = identify(measured(0.02), model_with(0.0))
    assert set(found.changes_by_refinement) >= {"mesh", "time_step"}
    assert found.model.parameters[MASS].standard_error == pytest.approx(2 * 0.001 * 1.2, rel=0.3)


def test_an_unknown_method_is_refused_with_the_nearest_name():
    """Before anything is simulated."""
    with pytest.raises(SysidError, match="least_squares"):
        identify(None, model_with(0.0), "least_square")
