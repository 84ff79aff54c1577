# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Numbers of a model file that may be freed."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import load_model, save_model
from hasel_sim.model.model_parameters import constants, shared_constants
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

DENSITY = "material.density_kg_per_m3"
SINGLE = ("material.soft.density_kg_per_m3", "material.spine.density_kg_per_m3")


def test_what_all_materials_have_in_common_is_one_number_besides():
    """The swimmer's density is, its modulus is not; a body of one material has nothing in common."""
    swimmer, beam = (load_model(name).description for name in ("swimmer", "beam"))
    assert shared_constants(swimmer)[DENSITY] == list(SINGLE)
    assert constants(swimmer)[DENSITY] == swimmer.material.soft.density_kg_per_m3
    assert "material.youngs_modulus_pa" not in constants(swimmer)
    assert shared_constants(beam) == {}


def test_it_is_set_in_all_of_them_before_what_is_named_of_one():
    """A single material's own value goes before the one that they have in common."""
    model = load_model("swimmer").with_freed(DENSITY, SINGLE[1])
    material = model.with_values({DENSITY: 1000.0, SINGLE[1]: 1200.0}).described.material
    assert material.soft.density_kg_per_m3 == 1000.0
    assert material.spine.density_kg_per_m3 == 1200.0


def test_its_file_is_read_back(tmp_path):
    """A model with it as a parameter, and one whose file has it in every material."""
    freed = load_model("swimmer").with_freed(DENSITY).with_values({DENSITY: 1000.0})
    save_model(freed, tmp_path / "model.yaml")
    assert load_model(tmp_path / "model.yaml") == freed
    settled = freed.with_constants_settled(DENSITY).description.material
    assert {settled.soft.density_kg_per_m3, settled.spine.density_kg_per_m3} == {1000.0}


def test_its_derivative_is_the_sum_of_those_of_every_material():
    """The angle moves by it as by all of them together."""
    time = np.arange(0.0, 0.3, 1 / 120)
    drive = DriveSchedule(np.array([0.0]), np.array([[4500.0, 0.0]]))
    model = load_model("swimmer").with_levels([4500.0]).with_values({"amplitude_4500": 0.03})
    together = simulate(model.with_freed(DENSITY), Run("box", time, drive), (DENSITY,)).slopes[:, 0]
    single = simulate(model.with_freed(*SINGLE), Run("box", time, drive), SINGLE).slopes
    assert np.abs(together).max() > 0
    assert together == pytest.approx(single.sum(axis=1), abs=1e-4 * np.abs(together).max())
