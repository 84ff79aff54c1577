# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Executables as processes."""

import time

import pytest
from hasel_bringup.errors import BringupError
from hasel_bringup.processes import Processes, executable


def test_an_installed_executable_is_found():
    """Where colcon puts it."""
    assert executable("hasel_sim", "simulator").name == "simulator"


@pytest.mark.parametrize("names", [("hasel_sim", "simulater"), ("hasel_sin", "simulator")])
def test_one_that_is_not_installed_is_said(names):
    """The sentence says what to do."""
    with pytest.raises(BringupError, match="make build"):
        executable(*names)


def test_a_failure_is_noticed_and_its_output_kept(tmp_path):
    """An executable that refuses its arguments ends at once; one that runs is left alone."""
    with Processes(tmp_path, {"ROS_DOMAIN_ID": "99"}) as processes:
        processes.start("hasel_bringup", "replay", "nothing.csv")
        end = time.monotonic() + 60
        with pytest.raises(BringupError, match=r"replay failed with exit code 1; see .*replay\.log"):
            while time.monotonic() < end:
                processes.check()
                time.sleep(0.05)
        assert "There is no file nothing.csv" in processes.output("replay").read_text()


def test_all_are_ended_on_the_way_out(tmp_path):
    """A node that waits forever is interrupted, and ends in good order."""
    with Processes(tmp_path, {"ROS_DOMAIN_ID": "99"}) as processes:
        processes.start("hasel_sysid", "sysid")
        end = time.monotonic() + 60
        while "Ready" not in processes.output("sysid").read_text():
            assert time.monotonic() < end
            processes.check()
            time.sleep(0.05)
        assert processes.stop("sysid") == 0
