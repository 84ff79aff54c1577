"""The demonstration's choice of files."""

from pathlib import Path

import pytest
from hasel_bringup.demo.command import Demo
from hasel_bringup.errors import BringupError

ROOT = Path(__file__).resolve().parents[5]
DATA = ROOT / "data" / "unseen_rig" / "quadratic_drag"


def test_nine_runs_are_fitted_and_three_never_seen(tmp_path):
    """One of the unseen is replayed."""
    demo = Demo(DATA, [], tmp_path / "out")
    assert (len(demo.fitted), len(demo.unseen)) == (9, 3)
    assert demo.replayed in demo.unseen
    assert not set(demo.fitted) & set(demo.unseen)


def test_a_folder_without_a_measured_body_is_refused(tmp_path):
    """Before anything is computed."""
    with pytest.raises(BringupError, match=r"gravity_a\.csv"):
        Demo(DATA, [tmp_path], tmp_path / "out")
