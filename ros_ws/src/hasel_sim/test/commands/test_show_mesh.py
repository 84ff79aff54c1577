"""The picture of the mesh."""

import numpy as np
import pytest
from hasel_sim.commands.show_mesh import main
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


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
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
