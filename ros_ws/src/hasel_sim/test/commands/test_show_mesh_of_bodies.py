# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The picture of a body shows all that its file describes."""

from pathlib import Path

from hasel_sim.mesh_picture import MUSCLES, draw_mesh
from hasel_sim.model import load_model

BODIES = Path(__file__).parents[2] / "docs" / "bodies"


def _legend(model) -> list[str]:
    (legend,) = draw_mesh(model).legends
    return [text.get_text() for text in legend.get_texts()]


def test_the_finger_is_drawn_with_muscles_region_plate_and_gravity():
    """Each is named in the legend; gravity has an arrow with its size."""
    model = load_model(BODIES / "finger.yaml")
    assert _legend(model) == [
        "soft", "muscle base (base)", "muscle middle (middle)", "muscle tip (tip)", "region nail",
        "clamped", "markers", "tip plate, 0.05 kg/m",
    ]  # fmt: skip
    (axes,) = draw_mesh(model).axes
    assert "g = 9.81 m/s²" in [text.get_text() for text in axes.texts]


def test_every_muscle_has_a_colour_of_its_own():
    """As long as there are colours."""
    assert len(set(MUSCLES)) == len(MUSCLES) >= 6


def test_a_marker_beside_the_centre_line_is_drawn_where_it_is():
    """The one-sided beam's fourth."""
    (axes,) = draw_mesh(load_model(BODIES / "one_sided_beam.yaml")).axes
    drawn = [line.get_xydata()[0].tolist() for line in axes.lines if line.get_color() == "#2ca02c"]
    assert [50.0, 4.0] in drawn
