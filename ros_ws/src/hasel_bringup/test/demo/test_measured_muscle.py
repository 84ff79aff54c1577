"""The measured muscle is found where the public repository has it."""

import pytest
from hasel_bringup.demo.measured_muscle import steps_in
from hasel_bringup.errors import BringupError


def test_steps_are_found_in_a_clone_and_in_its_folder(tmp_path):
    """Sines beside them are left alone."""
    folder = tmp_path / "post_process" / "raw_data"
    folder.mkdir(parents=True)
    for name in ("60g__step_a.mat", "60g__sin_a.mat"):
        (folder / name).touch()
    for given in (tmp_path, folder):
        assert [path.name for path in steps_in(given)] == ["60g__step_a.mat"]


def test_a_folder_without_steps_is_refused(tmp_path):
    """What was expected is named."""
    with pytest.raises(BringupError, match="MadhavL/PH-HASEL-Python"):
        steps_in(tmp_path)
