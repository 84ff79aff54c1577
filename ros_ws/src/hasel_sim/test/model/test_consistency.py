# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What does not fit together in a model file is refused in one sentence, and never ignored."""

from importlib import resources

import pytest
from hasel_common.yaml_text import read_yaml, yaml_text
from hasel_sim.errors import ModelError
from hasel_sim.model import load_model


@pytest.fixture
def refused(tmp_path):
    """The sentence with which the default swimmer is refused after a change of its file's content."""

    def read(change) -> str:
        content = read_yaml((resources.files("hasel_sim") / "models" / "swimmer.yaml").read_text())
        change(content)
        path = tmp_path / "model.yaml"
        path.write_text(yaml_text(content))
        with pytest.raises(ModelError) as error:
            load_model(path)
        return str(error.value)

    return read


def test_muscles_that_overlap_or_lie_outside_are_refused(refused):
    """With where they overlap, and how long the body is."""
    assert "'upper' and 'lower' overlap from 0.052 to 0.152 m" in refused(
        lambda c: c["muscles"][1].update(layer="upper")
    )
    assert "'lower' runs from 0.052 to 0.2 m; expected a stretch of the body between 0 and 0.16 m" in refused(
        lambda c: c["muscles"][1].update(to_m=0.2)
    )
    assert "'lower' runs from 0.1 to 0.05 m" in refused(
        lambda c: c["muscles"][1].update(from_m=0.1, to_m=0.05)
    )


def test_a_channel_without_a_muscle_and_the_reverse_are_refused(refused):
    """Neither does nothing silently."""
    assert "channel 'third' contracts no muscle" in refused(
        lambda c: c["channels"].append({"name": "third", "quantity": "voltage", "unit": "V"})
    )
    assert "channel 'uper', which channels does not list; the nearest known one is 'upper'" in refused(
        lambda c: c["muscles"][0].update(channel="uper")
    )


def test_names_are_told_apart(refused):
    """Two muscles or channels of one name."""
    assert "muscles: the name 'upper' is there twice" in refused(
        lambda c: c["muscles"][1].update(name="upper")
    )
    assert "channels: the name 'upper' is there twice" in refused(
        lambda c: c["channels"][1].update(name="upper")
    )


def test_a_marker_off_the_body_is_refused(refused):
    """Along it and across it; a fixed one may be anywhere."""
    assert "markers.tail.x_m is 0.5; expected 0 to 0.19 m" in refused(
        lambda c: c["markers"]["tail"].update(x_m=0.5)
    )
    assert "markers.tail.y_m is 0.002; expected at most 0.0005 m" in refused(
        lambda c: c["markers"]["tail"].update(y_m=0.002)
    )
    assert "markers has no 'head'" in refused(lambda c: c["markers"].pop("head"))


def test_a_unit_that_is_not_the_quantitys_is_refused(refused):
    """And a quantity that drives no body."""
    assert "'kV'" in refused(lambda c: c["channels"][0].update(unit="kV"))
    assert "'volts'" in refused(lambda c: c["channels"][0].update(quantity="volts"))


def test_a_region_beyond_the_body_is_refused(refused):
    """Of other material."""
    soft = {
        "youngs_modulus_pa": 1e6,
        "poissons_ratio": 0.45,
        "density_kg_per_m3": 900.0,
        "retardation_time_s": 0.0,
    }
    head = {"name": "head", "from_m": 0.0, "to_m": 0.3, "material": soft}
    assert "body.regions: 'head' runs from 0 to 0.3 m" in refused(lambda c: c["body"].update(regions=[head]))
