# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A simulator of the workbench's own, where the rig has none, and the proposed run as a line for the terminal."""

import time

import pytest
from hasel_common.yaml_text import read_yaml
from hasel_recording import DriveChannel
from hasel_sysid.answer.next_run import Manoeuvre
from hasel_sysid.errors import SysidError
from hasel_workbench.live.rig import OwnSimulator, goal_line


def test_its_last_words_are_told(tmp_path):
    """A model that it cannot simulate ends it; what it said is in a file, and nothing is left to end."""
    model = tmp_path / "broken.yaml"
    model.write_text("name: broken\n")
    simulator = OwnSimulator("/hasel")
    simulator.check()
    simulator.start(model)
    end = time.monotonic() + 100.0
    try:
        with pytest.raises(SysidError, match=r"the simulator that was started has ended: error: .*broken"):
            while time.monotonic() < end:
                simulator.check()
                time.sleep(0.05)
    finally:
        simulator.close()
    assert "broken" in (tmp_path / "simulator.log").read_text()
    simulator.check()


def test_the_line_sends_the_goal_of_the_run():
    """What stands in braces is the goal of RunExperiment, field by field."""
    run = Manoeuvre(4500.0, 1.5, 3, "box", "both")
    line = goal_line(run)
    assert line.startswith("ros2 action send_goal --feedback /hasel/run_experiment ")
    assert read_yaml(line[line.index('"') :].strip('"')) == run.goal()


def test_what_no_rig_can_make_has_no_line():
    """A release of a passive body, and a drive that is no voltage."""
    assert goal_line(Manoeuvre(0.0, 0.0, 0, "none", "both", load_factor=2.0)) == ""
    pressure = (DriveChannel("arm", "pressure", "Pa"),)
    assert goal_line(Manoeuvre(2e4, 1.0, 3, "box", "both", channels=pressure)) == ""
