# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The command that proves what the driver says."""

from types import SimpleNamespace

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")
pytest.importorskip("hasel_interfaces", reason="the workspace is not built")

from hasel_driver.testing import neighbours
from hasel_driver.testing.kinds import KINDS, Trial
from hasel_driver.tools import prove


def test_every_kind_is_a_row_and_what_is_wrong_is_told(monkeypatch, capsys):
    """Hardware first, then other nodes; the exit code says whether anything was wrong."""
    monkeypatch.setattr(prove, "KINDS", KINDS[:1])
    monkeypatch.setattr(prove, "UNSEEN", ())
    monkeypatch.setattr(neighbours, "NEIGHBOURS", neighbours.NEIGHBOURS[5:6])
    assert prove.main(["--rounds", "1"]) == 0
    first, second = capsys.readouterr().out.splitlines()[2:]
    assert first.startswith("| divider off | ")
    assert second == "| a stranger commands what is not armed | not obeyed | nothing |"
    monkeypatch.setattr(prove, "KINDS", ())
    monkeypatch.setattr(neighbours, "meet", lambda *_: Trial(0.6, ["4000 V"]))
    assert prove.main(["--rounds", "1"]) == 1
    assert "| 600 ms | 4000 V |" in capsys.readouterr().out


def test_the_channels_are_broken_by_turns(monkeypatch):
    """Rounds of a kind take no longer than with one channel."""
    channels: list[int] = []
    monkeypatch.setattr(prove, "Rig", lambda *_: SimpleNamespace(close=lambda: None))
    monkeypatch.setattr(
        prove, "_try_hardware", lambda kind, channel, rig: channels.append(channel) or Trial()
    )
    (row,) = prove.prove_hardware(prove.Trials([], 3), KINDS[:1])
    assert (channels, row.wrong) == ([0, 1, 0], [])


def test_beside_a_driver_that_runs_nothing_is_tried(virtual_rig, start_driver, ros, monkeypatch, capsys):
    """Its strangers would command a real supply."""
    start_driver(virtual_rig.port)
    ros.wait(lambda: bool(ros.states), 20.0)
    monkeypatch.setattr(prove, "KINDS", ())
    monkeypatch.setattr(prove, "UNSEEN", ())
    assert prove.main(["--rounds", "1"]) == 1
    assert "A driver answers to /hasel already" in capsys.readouterr().err
