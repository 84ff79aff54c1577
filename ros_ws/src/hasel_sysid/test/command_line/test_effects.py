# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`add` and `remove` write models."""

import pytest
from hasel_sim.model import load_model
from hasel_sysid.command_line.effects import add_main, remove_main


def test_add_then_remove_gives_the_model_back(tmp_path, capsys):
    """An added effect is in the file at its null value; removing it gives the first model's effects and parameters."""
    assert add_main(["quadratic_drag", "charging_lag", "--output", str(tmp_path)]) == 0
    path = tmp_path / "swimmer+quadratic_drag+charging_lag.yaml"
    added = load_model(path)
    assert [effect.id for effect in added.effects] == ["quadratic_drag", "charging_lag"]
    assert added.parameters["quadratic_drag.coefficient"].value == 0.0
    assert str(path) in capsys.readouterr().out
    back = tmp_path / "back.yaml"
    assert remove_main(["quadratic_drag", "charging_lag", "--model", str(path), "--output", str(back)]) == 0
    assert load_model(back).effects == ()
    assert load_model(back).parameters == load_model("swimmer").parameters


@pytest.mark.parametrize(
    ("main", "effect", "said"),
    [
        (add_main, "quadratic_drg", "the nearest known one is 'quadratic_drag'"),
        (remove_main, "quadratic_drag", "is not in model 'swimmer'"),
        (add_main, "nowhere.py:Mine", "nowhere.py"),
    ],
)
def test_wrong_effects_are_one_sentence(tmp_path, capsys, main, effect, said):
    """An unknown, absent or unfindable effect is refused with what to do, and nothing is written."""
    assert main([effect, "--output", str(tmp_path)]) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_list_names_the_catalogue(capsys):
    """`add --list` shows every effect with its physics."""
    assert add_main(["--list"]) == 0
    listed = capsys.readouterr().out
    assert "quadratic_drag" in listed
    assert len(listed.splitlines()) > 15


def test_an_effect_must_be_named(capsys):
    """Without an effect one sentence says what to give."""
    assert add_main([]) == 2
    assert "no effect was named; expected at least one" in capsys.readouterr().err
