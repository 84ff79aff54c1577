# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The demonstration's choice of files."""

import re
from pathlib import Path
from types import SimpleNamespace

import pytest
from hasel_bringup.demonstrations.demo import MEASURED_BODIES, Demo, _call, found_in, steps_in
from hasel_bringup.errors import BringupError
from hasel_sim.model import load_model
from hasel_sysid.command_line.running import MISLEADING
from hasel_sysid.errors import SysidError

ROOT = Path(__file__).resolve().parents[4]
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
