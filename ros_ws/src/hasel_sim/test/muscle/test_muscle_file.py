# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Muscle files: what comes with the package, writing and reading back, one-sentence errors."""

import pytest
from hasel_sim.errors import ModelError
from hasel_sim.model.muscle_file import load_muscle, muscle_names, muscle_text

POUCH = (
    "pouch: {count: 3, film_length_m: 0.02, electrode_length_m: 0.01, width_m: 0.05, film_thickness_m: 1.0e-5, "
    "relative_permittivity: 2.0}\n"
)


@pytest.fixture
def written(tmp_path):
    """Write a muscle file; returns its path."""

    def write(text):
        path = tmp_path / "muscle.yaml"
        path.write_text(text)
        return path

    return write


@pytest.mark.parametrize("name", muscle_names())
def test_muscles_of_the_package_load(name):
    """Every muscle that comes with the package is one that can contract."""
    assert load_muscle(name).pouch.largest_contraction > 0


def test_a_muscle_survives_its_file(written):
    """What is written reads back to the same muscle, effects and standard errors included."""
    muscle = load_muscle("peano_hasel").with_effects("edge_effect", "film_creep")
    muscle = muscle.with_values({"edge_effect.strip": 0.3, "pouch.fill": 0.9}, {"edge_effect.strip": 0.02})
    assert load_muscle(written(muscle_text(muscle))) == muscle


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "name: x\n" + POUCH.replace("film_length_m", "film_lenght_m"),
            "nearest known one is 'film_length_m'",
        ),
        (
            "name: x\n" + POUCH.replace("width_m: 0.05", "width_mm: 50"),
            "convert the value from mm to m, here 0.05",
        ),
        ("name: x\n", "the key 'pouch' is missing"),
        ("just words", "holds no muscle"),
        ("name: x\n" + POUCH + "effects: [edge]\n", "nearest known one is 'edge_effect'"),
        ("name: x\n" + POUCH + "parameters: {pouch.fil: {value: 1}}\n", "nearest known one is 'pouch.fill'"),
        (
            "name: x\n" + POUCH + "parameters: {pouch.fill: {value: 1, correlations: {a: 0.5}}}\n",
            "a muscle file keeps none",
        ),
        ("name: x\n" + POUCH + "parameters: {pouch.fill: {value: 9}}\n", "between its bounds 0.5 and 1.5"),
        ("name: x\n" + POUCH + "parameters: {pouch.fill: {unit: ml}}\n", "expected '1'"),
    ],
)
def test_faults_get_one_sentence(written, text, message):
    """What is wrong with a file is said with what was expected."""
    with pytest.raises(ModelError, match=message):
        load_muscle(written(text))


def test_a_missing_file_is_named(tmp_path):
    """The names that are known are listed."""
    with pytest.raises(ModelError, match="peano_hasel"):
        load_muscle(tmp_path / "none.yaml")
