# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where a report says that it comes from."""

import sys

import pytest
from hasel_sysid.report.content import called_as, provenance


@pytest.mark.parametrize(
    ("program", "said"),
    [
        ("/opt/install/hasel_sysid/lib/hasel_sysid/fit", "ros2 run hasel_sysid fit 'my run.csv'"),
        ("/home/ann/mine.py", "mine.py 'my run.csv'"),
    ],
)
def test_the_command_is_the_one_that_was_typed(monkeypatch, program, said):
    """An installed executable by `ros2 run`, a script of one's own by its name; blanks are quoted."""
    monkeypatch.setattr(sys, "argv", [program, "my run.csv"])
    assert provenance().command == said


def test_a_command_that_another_one_calls_says_itself(monkeypatch):
    """Not the demo's name: what makes this report again."""
    monkeypatch.setattr(sys, "argv", ["/opt/lib/hasel_bringup/demo"])
    with called_as("hasel_sysid", "improve", "run.csv"):
        assert provenance().command == "ros2 run hasel_sysid improve run.csv"
    assert provenance().command == "ros2 run hasel_bringup demo"
