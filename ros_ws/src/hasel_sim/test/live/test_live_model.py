# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The model that the node starts with."""

import pytest
from hasel_sim.errors import ModelError
from hasel_sim.live.live_simulator import live_model
from hasel_sim.model import save_model


def test_a_model_never_fitted_gets_an_amplitude_and_a_warning():
    """Otherwise the simulated body would not move, and nobody would be told."""
    model, warning = live_model("swimmer")
    assert model.levels.tolist() == [5500.0]
    assert "never fitted" in warning


def test_a_fitted_model_is_taken_as_it_is(tmp_path, swimmer):
    """A model file with amplitudes needs no warning."""
    path = tmp_path / "fitted.yaml"
    save_model(swimmer, path)
    model, warning = live_model(str(path))
    assert (model.values, warning) == (swimmer.values, "")


def test_a_body_without_muscles_needs_no_amplitude():
    """The beam is passive."""
    model, warning = live_model("beam")
    assert (len(model.levels), warning) == (0, "")


def test_an_unknown_model_is_named_with_the_nearest_known():
    """A slip of the pen is answered by one sentence."""
    with pytest.raises(ModelError, match="swimmer"):
        live_model("swimer")
