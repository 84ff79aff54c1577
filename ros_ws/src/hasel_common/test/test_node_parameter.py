# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a node answers to --help, and which arguments it takes."""

import pytest
from hasel_common.node_parameter import NodeParameter, answer_help, user_arguments

PARAMETERS = [("rate", 1.5, "angles per second"), ("effects", [""], "added"), ("quiet", False, "says less")]


def test_help_lists_parameters_and_leaves(capsys):
    """Name, default and meaning of each, exit code 0."""
    with pytest.raises(SystemExit) as left:
        answer_help("simulator", "Simulates.", PARAMETERS, ["--help"])
    assert left.value.code == 0
    text = capsys.readouterr().out
    assert text.startswith("usage: simulator [--help]")
    assert "rate:=1.5" in text
    assert "effects:=[]" in text
    assert "quiet:=false" in text


def test_an_unknown_argument_is_refused(capsys):
    """A parameter without --ros-args would otherwise be ignored without a word."""
    with pytest.raises(SystemExit) as left:
        answer_help("simulator", "Simulates.", PARAMETERS, ["rate:=3"])
    assert left.value.code == 2
    assert "rate:=3" in capsys.readouterr().err


def test_arguments_for_ros_are_left_to_ros():
    """As launch files give them; after -- come the node's own again."""
    given = ["a", "--ros-args", "-p", "rate:=3", "--help", "--", "b"]
    assert user_arguments(given) == ["a", "b"]
    assert answer_help("simulator", "Simulates.", PARAMETERS, given[1:5]) is None


def test_a_range_has_two_ends():
    """One end alone would never be checked."""
    assert NodeParameter("rate", 120.0, "of the camera", "1/s", 1, 1000).span == (1, 1000)
    assert NodeParameter("quiet", False, "says less").span is None
    with pytest.raises(ValueError, match="rate has one end of a range"):
        NodeParameter("rate", 120.0, "of the camera", "1/s", low=1)
