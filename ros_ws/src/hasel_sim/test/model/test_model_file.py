# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Model files: what is refused and how, and what comes back."""

from importlib import resources

import numpy as np
import pytest
from hasel_common.yaml_text import read_yaml, yaml_text
from hasel_sim.errors import ModelError, OwnCodeError
from hasel_sim.model import load_model, model_names, save_model
from hasel_sim.simulate import simulate

OWN_EFFECT = """
from hasel_sim.effects.base import DriveEffect, EffectParameter


class Gain(DriveEffect):
    id = "gain"
    physics = "A gain."
    equation = "u = g v"
    parameters = (EffectParameter("factor", "g", "1", 1.0, 0.0, 2.0, 0.5),)

    def respond(self, time, signal, p):
        return p.factor * signal
"""


@pytest.fixture
def content() -> dict:
    """The default swimmer's file as a dictionary."""
    return read_yaml((resources.files("hasel_sim") / "models" / "swimmer.yaml").read_text())


@pytest.fixture
def refusal(tmp_path):
    """The sentence with which a file of this content is refused."""

    def read(content: dict) -> str:
        path = tmp_path / "model.yaml"
        path.write_text(yaml_text(content))
        with pytest.raises(ModelError) as error:
            load_model(path)
        return str(error.value)

    return read


def test_the_models_that_come_with_the_package_can_be_read():
    """By their names."""
    assert model_names() == ["arm", "beam", "swimmer", "swimmer_by_law", "swimmer_in_oil"]
    for name in model_names():
        assert load_model(name).name == name


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("amplitude_5500.0", "'amplitude_5500'"),
        ("amplitude_5.5kV", "'amplitude_<level>' with the level in V, such as 'amplitude_5500'"),
        ("amplitude_-5500", "'amplitude_<level>' with the level in V, such as 'amplitude_5500'"),
    ],
)
def test_an_amplitude_that_is_named_otherwise_is_refused_with_its_name(name, expected, content, refusal):
    """In the one way in which it is looked up, by the level in SI units."""
    content["parameters"] = {name: {"value": 0.05}}
    assert f"unknown parameter '{name}'; an amplitude is named {expected}: rename it" in refusal(content)


def test_a_number_in_the_place_of_a_section_is_refused_with_the_section_s_keys(content, refusal):
    """A parameter is a section with a value, a material one with its constants."""
    content["parameters"] = {"slope": 0.3}
    assert "parameters.slope is 0.3; expected a section with keys of value, unit, lower" in refusal(content)
    del content["parameters"]
    content["material"]["soft"] = 5e5
    assert "material.soft is 500000.0; expected a section with keys of youngs_modulus_pa" in refusal(content)


def test_an_unknown_key_is_refused_with_the_nearest_known_one(content, refusal):
    """At the top and inside a section."""
    content["numerics"]["mesh_densty"] = 2.0
    assert "unknown key 'numerics.mesh_densty'; the nearest known one is 'mesh_density'" in refusal(content)
    del content["numerics"]["mesh_densty"]
    content["marker"] = {}
    assert "unknown key 'marker'; the nearest known one is 'markers'" in refusal(content)


def test_a_key_with_another_unit_is_refused_with_the_right_one(content, refusal):
    """Millimetres where metres are expected."""
    spine = content["body"]["spine"]
    spine["fin_length_mm"] = 1000 * spine.pop("fin_length_m")
    assert (
        "unknown key 'body.spine.fin_length_mm'; the nearest known one is 'fin_length_m', in m: rename it and convert "
        "the value from mm to m, here 0.03"
    ) in refusal(content)
    content["muscles"][1]["to_mm"] = 152.0
    spine["fin_length_m"] = 1e-3 * spine.pop("fin_length_mm")
    assert "unknown key 'muscles.1.to_mm'; the nearest known one is 'to_m', in m" in refusal(content)


def test_a_misspelt_key_goes_before_the_one_that_is_missing_by_it(content, refusal):
    """Not "is missing: add it", which would send the user looking."""
    content["body"]["lenght_m"] = content["body"].pop("length_m")
    assert "unknown key 'body.lenght_m'; the nearest known one is 'length_m'" in refusal(content)


@pytest.mark.parametrize(
    ("section", "key", "value", "expected"),
    [
        (("body", "spine"), "fin_length_m", 300.0, "fin_length_m is 300 m; expected 1e-06 to 10 m"),
        (("material", "soft"), "youngs_modulus_pa", 0.065, "youngs_modulus_pa is 0.065 Pa; expected 1 to"),
        (("material", "soft"), "density_kg_per_m3", 0.9, "density_kg_per_m3 is 0.9 kg/m^3; expected 10 to"),
    ],
)
def test_a_number_that_no_body_has_is_noticed(section, key, value, expected, content, refusal):
    """Mostly another unit: millimetres, megapascals, grams per cubic centimetre."""
    content[section[0]][section[1]][key] = value
    assert expected in refusal(content)


@pytest.mark.parametrize(
    ("section", "key", "value", "expected"),
    [
        ("body", "length_m", -0.1, "greater than 0"),
        ("body", "length_m", float("nan"), "finite"),
        ("material", "plane", "shell", "'strain' or 'stress'"),
        ("numerics", "quadrature_order", 5, "2 or 3"),
        ("numerics", "layers", 0, "greater than or equal to 1"),
        ("body", "height_m", 0.01, "either height_m or outline"),
    ],
)
def test_a_value_out_of_range_is_refused_with_what_was_expected(
    section, key, value, expected, content, refusal
):
    """One sentence that names the key."""
    content[section][key] = value
    sentence = refusal(content)
    assert section in sentence
    assert expected in sentence


def test_a_missing_section_is_named(content, refusal):
    """Markers for all, a material for a spine."""
    spine = content["material"].pop("spine")
    assert "body.spine has no material; expected material.spine" in refusal(content)
    content["material"]["spine"] = spine
    del content["markers"]
    assert "the key 'markers' is missing: add it" in refusal(content)


def test_an_outline_that_crosses_the_spine_is_refused_when_the_file_is_read(content, refusal):
    """Before any simulation."""
    content["body"]["outline"]["coefficients"] = [0.3, -1.0]
    assert "crosses the spine" in refusal(content)


def test_a_marker_outside_the_body_is_refused_when_the_file_is_read(content, refusal):
    """It names the marker."""
    content["markers"]["tail"]["x_m"] = 0.5
    sentence = refusal(content)
    assert "tail" in sentence
    assert "0.5" in sentence


def test_an_unknown_effect_or_parameter_is_refused(content, refusal):
    """With the nearest known name."""
    content["parameters"]["slop"] = {"value": 1.0}
    assert "unknown parameter 'slop'; the nearest known one is 'slope'" in refusal(content)
    del content["parameters"]["slop"]
    content["effects"] = ["quadratic_drg"]
    assert "unknown effect 'quadratic_drg'; the nearest known one is 'quadratic_drag'" in refusal(content)


def test_a_parameter_in_another_unit_is_refused(content, refusal):
    """The unit a parameter has is known."""
    content["parameters"]["slope"]["unit"] = "1/ms"
    assert "slope is given in '1/ms'; expected '1/s'" in refusal(content)


def test_a_file_that_is_no_model_is_refused(tmp_path):
    """No file, no YAML, no mapping."""
    with pytest.raises(ModelError, match="the nearest known one is 'swimmer'"):
        load_model("swimer")
    path = tmp_path / "model.yaml"
    for text, expected in (("a: [1", "not valid YAML"), ("- 1", "holds no model")):
        path.write_text(text)
        with pytest.raises(ModelError, match=expected):
            load_model(path)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ModelError, match="not a text file"):
        load_model(path)


def test_a_saved_model_comes_back_the_same(tmp_path, boxes):
    """Parameters, bounds, errors and effects; it simulates to the same angles."""
    model = load_model("swimmer").with_levels(np.array([4500.0, 5500.0])).with_effects("quadratic_drag")
    model = model.with_values({"slope": 0.3, "amplitude_5500": 0.05}, {"slope": 0.01})
    save_model(model, tmp_path / "model.yaml")
    back = load_model(tmp_path / "model.yaml")
    assert back == model
    run = boxes(duration=0.1)
    assert np.array_equal(simulate(back, run).sin_theta, simulate(model, run).sin_theta)


def test_an_effect_of_ones_own_is_found_beside_the_model_file(tmp_path):
    """And is still found after saving somewhere else."""
    (tmp_path / "gain.py").write_text(OWN_EFFECT)
    (tmp_path / "elsewhere").mkdir()
    save_model(load_model("swimmer"), tmp_path / "model.yaml")
    text = (tmp_path / "model.yaml").read_text()
    (tmp_path / "model.yaml").write_text(text.replace("effects: []", 'effects: ["gain.py:Gain"]'))
    model = load_model(tmp_path / "model.yaml")
    assert "gain.factor" in model.parameters
    save_model(model, tmp_path / "elsewhere" / "model.yaml")
    assert "gain.factor" in load_model(tmp_path / "elsewhere" / "model.yaml").parameters


@pytest.mark.parametrize(
    ("medium", "density", "viscosity"),
    [
        ("water", 998.0, 1e-3),
        ({"fluid": "canola_oil", "viscosity_pa_s": 0.06}, 920.0, 0.06),
        ({"density_kg_per_m3": 1200.0, "viscosity_pa_s": 0.01}, 1200.0, 0.01),
    ],
)
def test_a_medium_is_named_or_described(tmp_path, content, medium, density, viscosity):
    """A fluid by name, by name with another viscosity, or by its constants, which may be freed; also read back."""
    content["medium"], content["body"]["depth_m"] = medium, 0.04
    content["parameters"]["medium.viscosity_pa_s"] = {"lower": 1e-4, "upper": 1.0}
    content["effects"] = ["normal_drag"]
    (tmp_path / "model.yaml").write_text(yaml_text(content))
    save_model(load_model(tmp_path / "model.yaml"), tmp_path / "again.yaml")
    model = load_model(tmp_path / "again.yaml")
    around = model.described.surroundings
    assert (around.density, around.viscosity) == (density, viscosity)
    assert (around.depth, around.length) == (0.04, pytest.approx(0.19))
    thicker = model.with_values({"medium.viscosity_pa_s": 0.5})
    assert thicker.described.surroundings.viscosity == 0.5
    assert model.parameters["medium.viscosity_pa_s"].unit == "Pa s"


@pytest.mark.parametrize(
    ("medium", "depth", "said"),
    [
        ("canola", 0.05, "the fluid 'canola' is not known; the nearest known one is 'canola_oil'"),
        ("water", None, "medium is given for a body without depth; expected body.depth_m"),
        ({"fluid": "water", "viscosity_mpa_s": 1.0}, 0.05, "unknown key 'medium.viscosity_mpa_s'"),
        ({"density_kg_per_m3": 900.0}, 0.05, "medium.viscosity_pa_s' is missing"),
        ("water", 50.0, "body.depth_m is 50 m; expected 1e-06 to 10 m"),
    ],
)
def test_a_wrong_medium_is_refused(refusal, content, medium, depth, said):
    """An unknown fluid, a body without depth, an unknown or a missing key, a depth in millimetres."""
    content["medium"] = medium
    if depth is not None:
        content["body"]["depth_m"] = depth
    assert said in refusal(content)


@pytest.mark.parametrize(
    ("correlations", "said"),
    [
        ("{slop: 0.5}", "the nearest known one is 'slope'"),
        ("{amplitude_5500: 0.5}", "expected another of the file's parameters"),
        ("{slope: 1.5}", "less than or equal to 1"),
    ],
)
def test_correlations_that_make_no_sense_are_refused(tmp_path, correlations, said):
    """With a name that is none, with itself, beyond 1."""
    text = (resources.files("hasel_sim") / "models" / "swimmer_in_oil.yaml").read_text()
    line = 'amplitude_5500: {value: 0.0624, unit: "1",'
    assert line in text
    (tmp_path / "m.yaml").write_text(text.replace(line, f"{line} correlations: {correlations},"))
    with pytest.raises(ModelError, match=said):
        load_model(tmp_path / "m.yaml")


def test_a_model_that_nobody_chose_brings_no_code(tmp_path, content):
    """As one that a recording names: its effect's file is not run."""
    (tmp_path / "effect.py").write_text("raise SystemExit('it ran')")
    (tmp_path / "model.yaml").write_text(yaml_text({**content, "effects": ["effect.py:Evil"]}))
    with pytest.raises(OwnCodeError, match=r"model.yaml has the effect effect.py:Evil, which is code"):
        load_model(tmp_path / "model.yaml", own_code=False)
