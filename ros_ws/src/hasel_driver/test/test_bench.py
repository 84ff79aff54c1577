# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The benchmark: its lines, and what it returns."""

import re

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")
pytest.importorskip("hasel_interfaces", reason="the workspace is not built")

from hasel_driver import start
from hasel_driver.tools import driver_bench


def test_a_missed_bar_is_said_and_returned():
    """Percentile and verdict are of the values given."""
    line, met = driver_bench.report("latency", [0.001] * 99 + [0.004], 0.005, 100)
    assert (met, "maximum 4.00 ms (bar 5 ms: met; n = 100)" in line) == (True, True)
    line, met = driver_bench.report("latency", [0.002, 0.009], 0.005, 99)
    assert (met, "MISSED" in line) == (False, True)


@pytest.mark.parametrize("supply", ["virtual", "firmware"])
def test_measures_latency_rate_and_grounding(capsys, monkeypatch, request, supply):
    """A short run prints the three figures, each from as many measurements as were asked for."""
    monkeypatch.setattr(driver_bench, "FLAT_OUT_S", 1.0)
    arguments = ["--commands", "50", "--kills", "1"]
    if supply == "firmware":
        arguments += ["--firmware", str(request.getfixturevalue("firmware_build"))]
    for _ in range(3):  # a machine that is late makes the measurement fail, which is said
        start.bench(arguments)
        output = capsys.readouterr()
        if "try again on a machine with less to do" not in output.err:
            break
    lines = output.out.splitlines()
    assert int(re.search(r"command to wire: median .* n = (\d+)", lines[0])[1]) > 25
    assert int(re.search(r"commands obeyed: (\d+) /s", lines[1])[1]) > 10
    assert "node killed to output grounded: median" in lines[2]


def test_counts_the_experiments_that_a_busy_machine_ends(capsys, monkeypatch):
    """How many were begun and how many ended by a fault, each by its sentence."""
    monkeypatch.setattr(driver_bench, "EXPERIMENT_S", 0.5)
    start.bench(["--commands", "0", "--experiments", "2"])
    lines = capsys.readouterr().out.splitlines()
    ended = int(re.search(r"experiments ended by a fault: (\d) of 2 at a load of", lines[0])[1])
    assert len(lines) == 1 + ended


def test_a_folder_without_the_firmware_is_said(capsys, tmp_path):
    """One sentence, not a trace."""
    with pytest.raises(SystemExit):
        start.bench(["--firmware", str(tmp_path)])
    assert "build them with make first" in capsys.readouterr().err
