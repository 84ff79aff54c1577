# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the options of a command mean."""

import pytest
from hasel_sysid.command_line import diagnose, improve, inputs, suggest
from hasel_sysid.command_line.options import check_parser, compare_parser, diagnose_parser, improve_parser


def test_effects_of_ones_own_are_added_to_the_catalogue():
    """--add is the same as --effects with a + before each."""
    for given in (["--effects", "+mine.py:Mine,+tether"], ["--add", "mine.py:Mine", "--add", "tether"]):
        assert list(improve_parser().parse_args(["run.csv", *given]).effects) == ["+mine.py:Mine", "+tether"]
    assert list(improve_parser().parse_args(["run.csv", "--effects", "tether"]).effects) == ["tether"]
    assert improve_parser().parse_args(["run.csv"]).effects is None


@pytest.mark.parametrize("command", [diagnose, improve, suggest])
def test_a_wrong_effect_is_refused_before_a_recording_is_read(command, monkeypatch, capsys):
    """A misspelt one, and a file without its class."""
    monkeypatch.setattr(inputs, "load_all", None)
    assert command.main(["run.csv", "--add", "quadratic_darg"]) == 2
    assert "the nearest known one is 'quadratic_drag'" in capsys.readouterr().err
    assert command.main(["run.csv", "--add", "own/cubic_drag.py"]) == 2
    assert "expected path/to/file.py:ClassName: write own/cubic_drag.py:CLASS" in capsys.readouterr().err


@pytest.mark.parametrize("parser", [check_parser, compare_parser, diagnose_parser])
def test_an_option_that_took_the_recordings_is_said(parser, capsys):
    """--drive FILE RECORDING leaves no recording; it is not only said that one is required."""
    with pytest.raises(SystemExit) as left:
        parser().parse_args(["--drive", "supply.csv", "run.csv"])
    assert left.value.code == 2
    assert "takes every file that follows it: name the recordings first" in capsys.readouterr().err
