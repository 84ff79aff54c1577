"""The demonstration's choice of files."""

import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from hasel_bringup.demo.command import Demo, _call
from hasel_bringup.errors import BringupError
from hasel_sysid.command_line.running import MISLEADING
from hasel_sysid.errors import SysidError

ROOT = Path(__file__).resolve().parents[5]
DATA = ROOT / "data" / "unseen_rig" / "quadratic_drag"


def test_nine_runs_are_fitted_and_three_never_seen(tmp_path):
    """One of the unseen is replayed."""
    demo = Demo(DATA, [], tmp_path / "out")
    assert (len(demo.fitted), len(demo.unseen)) == (9, 3)
    assert demo.replayed in demo.unseen
    assert not set(demo.fitted) & set(demo.unseen)


def test_it_says_how_to_go_on_by_hand(tmp_path, monkeypatch, capsys):
    """With the workbench, on the demonstration's own runs."""
    demo = Demo(DATA, [], tmp_path / "out")
    monkeypatch.setattr(demo, "_step", lambda title, work: None)
    demo.run()
    said = capsys.readouterr().out
    command = re.search(r"bin/ros2 run hasel_workbench workbench (\S+) --validate (\S+) --output", said)
    assert [Path(pattern).parent for pattern in command.groups()] == [DATA, DATA]
    assert [len(list(DATA.glob(Path(pattern).name))) for pattern in command.groups()] == [9, 3]
    assert (ROOT / "bin" / "ros2").exists()


def test_a_folder_without_a_measured_body_is_refused(tmp_path):
    """Before anything is computed."""
    with pytest.raises(BringupError, match=r"gravity_a\.csv"):
        Demo(DATA, [tmp_path], tmp_path / "out")


def test_a_folder_without_films_of_the_fish_is_refused(tmp_path):
    """Likewise."""
    with pytest.raises(SysidError, match="srl-ethz/fishsim"):
        Demo(DATA, [], tmp_path / "out", fish=tmp_path)


@pytest.mark.parametrize(("code", "goes_on"), [(0, True), (MISLEADING, True), (2, False), (130, False)])
def test_a_misleading_recording_does_not_end_the_demo(code, goes_on):
    """What the data gate says of a recording is printed; only a command that fails ends the demonstration."""
    command = SimpleNamespace(__name__="hasel_sysid.command_line.fit", main=lambda arguments: code)
    if goes_on:
        _call(command, [])
    else:
        with pytest.raises(BringupError, match=f"fit failed with exit code {code}"):
            _call(command, [])
