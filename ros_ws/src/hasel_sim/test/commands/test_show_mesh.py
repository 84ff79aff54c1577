# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The picture of the mesh."""

import numpy as np
import pytest
from hasel_sim.commands.entry import show_mesh as main
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.mesh_picture import draw_angle
from hasel_sim.model import load_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from matplotlib.image import imread


def test_the_swimmer_is_drawn_with_its_muscles_and_markers(tmp_path, capsys):
    """Both muscles' colours and the markers' cover some of the picture; the upper muscle lies above the lower."""
    path = tmp_path / "swimmer.png"
    assert main(["--output", str(path)]) == 0
    assert f"Drew {path}" in capsys.readouterr().out
    picture = imread(path)[..., :3]
    colours = {"upper": (0xD9, 0x65, 0x4B), "lower": (0x4B, 0x86, 0xB4), "marker": (0x2C, 0xA0, 0x2C)}
    rows = {}
    for name, colour in colours.items():
        found = np.abs(picture - np.array(colour) / 255).max(axis=-1) < 0.01
        assert found.sum() > 300, name
        rows[name] = np.median(np.nonzero(found)[0])
    assert rows["upper"] < rows["marker"] < rows["lower"]


def test_a_vector_picture_of_another_model_and_density(tmp_path):
    """SVG, with the number of nodes of the denser mesh in its title."""
    path = tmp_path / "beam.svg"
    assert main(["beam", "--density", "2", "--output", str(path)]) == 0
    assert path.read_text().startswith("<?xml")


def test_the_bent_body_shows_the_angle_between_its_markers(tmp_path):
    """θ is that of a run held at this level; the picture is written as any other."""
    model = load_model("swimmer").with_numerics(mesh_density=0.5).with_levels([5500.0])
    texts = [text.get_text() for text in draw_angle(model, 5500.0).axes[0].texts]
    (said,) = (text for text in texts if "θ" in text)
    held = DriveSchedule(np.zeros(1), np.array([[5500.0, 0.0]]))
    seen = simulate(model, Run("held", np.arange(0.0, 0.5, 1 / 60), held)).sin_theta
    largest = np.degrees(np.arcsin(seen[np.argmax(np.abs(seen))]))
    assert said == f"θ = {largest:.0f}°" and abs(largest) > 5
    assert {"head", "middle", "tail"} < set(texts)
    path = tmp_path / "bent.svg"
    assert main(["--density", "0.5", "--bent", "5500", "--output", str(path)]) == 0
    assert path.read_text().startswith("<?xml")


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["beam", "--bent", "5500"], "nothing drives model 'beam'"),
        (["swimer"], "the nearest known one is 'swimmer'"),
        (["--output", "mesh.bmp"], "expected .png, .svg, .pdf"),
        (["--density", "-1"], "numerics.mesh_density is -1.0"),
        (["--output", "/no/such/folder/mesh.png"], "cannot be written"),
    ],
)
def test_what_cannot_be_drawn_is_said_in_one_sentence(arguments, expected, capsys):
    """And the exit status is 1."""
    assert main(arguments) == 1
    assert expected in capsys.readouterr().err
