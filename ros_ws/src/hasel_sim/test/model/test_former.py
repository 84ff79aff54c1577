# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Model files of the former kinds of body stay valid."""

import numpy as np
import pytest
from hasel_sim.errors import ModelError
from hasel_sim.model import load_model
from hasel_sim.model_mesh import model_mesh

FORMER_SWIMMER = """
name: swimmer
body:
  kind: swimmer
  body_length_m: 0.160
  fin_length_m: 0.030
  spine_thickness_m: 0.001
  largest_half_height_m: 0.0075
  outline_coefficients: [0.3, 5.13847447, -13.84583811, 19.51736782, -18.6011192, 7.61111502]
  head_length_m: 0.052
  muscle_end_m: 0.152
material:
  plane: strain
  soft: {youngs_modulus_pa: 65.0e+3, poissons_ratio: 0.45, density_kg_per_m3: 900.0, retardation_time_s: 0.020}
  spine: {youngs_modulus_pa: 130.0e+3, poissons_ratio: 0.45, density_kg_per_m3: 900.0, retardation_time_s: 0.020}
muscle:
  fibre_stiffness_pa: 65.0e+3
markers:
  head: {x_m: 0.005}
  middle: {x_m: 0.094}
  tail: {x_m: 0.190}
effects: [quadratic_drag]
parameters:
  slope: {value: 0.3, unit: 1/s, lower: 0.02, upper: 50.0}
  amplitude_5500: {value: 0.06, unit: "1", lower: 0.0, upper: 0.6}
  quadratic_drag.coefficient: {value: 0.2, unit: "1", lower: 0.0, upper: 10.0}
"""
FORMER_RECTANGLE = """
name: strip
body: {kind: rectangle, length_m: 0.1, height_m: 0.01, clamped: true}
material:
  soft: {youngs_modulus_pa: 1.0e+5, poissons_ratio: 0.45, density_kg_per_m3: 1000.0, retardation_time_s: 0.0}
markers: {head: {x_m: 0.0}, middle: {x_m: 0.05}, tail: {x_m: 0.1}}
"""


@pytest.fixture
def written(tmp_path):
    """The path of a model file with this text."""

    def write(text: str):
        path = tmp_path / "model.yaml"
        path.write_text(text)
        return path

    return write


def test_a_former_swimmer_is_the_swimmer_of_today(written):
    """The same body and muscles; its quadrature stays the full one that it had."""
    former, today = load_model(written(FORMER_SWIMMER)), load_model("swimmer")
    assert np.array_equal(model_mesh(former).nodes, model_mesh(today).nodes)
    assert former.description.material == today.description.material
    assert [m.stretch for m in former.description.muscles] == [m.stretch for m in today.description.muscles]
    assert former.description.numerics.quadrature_order == 3
    assert former.values["amplitude_5500"] == 0.06


def test_a_former_rectangle_is_read(written):
    """Clamped or not."""
    model = load_model(written(FORMER_RECTANGLE))
    assert len(model_mesh(model).clamped)
    assert not model.has_muscles


def test_a_muscle_that_did_nothing_is_refused(written):
    """A rectangle's, which was read and ignored."""
    with pytest.raises(ModelError, match=r"a rectangle has no place for the section 'muscle'"):
        load_model(written(FORMER_RECTANGLE + "muscle: {fibre_stiffness_pa: 1.0e+4}\n"))


def test_what_is_wrong_in_a_former_file_is_said_in_its_own_words(written):
    """An unknown key, a missing one, an unknown kind."""
    for old, new, sentence in (
        (
            "fin_length_m",
            "fin_length_mm",
            "unknown key 'body.fin_length_mm'; the nearest known one is 'fin_len",
        ),
        ("  head_length_m: 0.052\n", "", "the key 'body.head_length_m' of a swimmer is missing"),
        ("kind: swimmer", "kind: circle", "expected swimmer or rectangle"),
    ):
        with pytest.raises(ModelError, match=sentence):
            load_model(written(FORMER_SWIMMER.replace(old, new)))
