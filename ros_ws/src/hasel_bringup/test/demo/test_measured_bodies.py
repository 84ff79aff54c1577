"""Measured bodies are found by their recordings' names."""

import pytest
from hasel_bringup.demo.measured_bodies import MEASURED_BODIES, found_in
from hasel_bringup.errors import BringupError
from hasel_sim.model import load_model


def test_bodies_are_found_in_a_folder_and_in_folders_within(tmp_path):
    """Each with its fitted and its unseen files; a set that is not complete is none."""
    for body in MEASURED_BODIES:
        (tmp_path / body.name).mkdir()
        for name in (*body.fitted, *body.unseen):
            (tmp_path / body.name / name).touch()
    assert [body.name for body, _, _ in found_in([tmp_path])] == ["arm", "beam", "loaded_beam"]
    ((body, fitted, unseen),) = found_in([tmp_path / "arm"])
    assert (body.model, len(fitted), [path.name for path in unseen]) == ("arm", 4, ["step_250mbar.csv"])
    unseen[0].unlink()
    with pytest.raises(BringupError, match=r"no measured body in .*step_250mbar\.csv"):
        found_in([tmp_path / "arm"])


def test_the_models_they_are_compared_with_exist():
    """By name."""
    for body in MEASURED_BODIES:
        assert load_model(body.model).name == body.model
