# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The live loop without hardware, as its user starts it."""

import json
import os
import re
import signal
import subprocess
import time
from pathlib import Path

import pytest
from hasel_bringup.processes import executable
from hasel_recording import read_recording
from hasel_recording.bag import read_file
from hasel_recording.mcap_recorder import HEADER_RECORD


def start(folder: Path, *arguments: str) -> subprocess.Popen:
    """The demonstration, with its output in a file of the folder."""
    with (folder / "printed.txt").open("w") as output:
        return subprocess.Popen(
            [executable("hasel_bringup", "live_demo"), "--seed", "1", "--output", "out", *arguments],
            stdout=output,
            stderr=subprocess.STDOUT,
            cwd=folder,
            env={**os.environ, "PYTHONUNBUFFERED": "1", "COLUMNS": "200"},
            start_new_session=True,
        )


def left_over(folder: Path) -> list[str]:
    """Command lines of processes that still use the folder."""
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            words = path.read_bytes().split(b"\0")
        except OSError:
            continue
        if any(str(folder).encode() in word for word in words):
            found.append(b" ".join(words).decode(errors="replace"))
    return found


@pytest.mark.timeout(600)
def test_one_run_goes_through_supply_camera_and_tracker(tmp_path):
    """One run: the driver's voltage and a tracked angle in one recording that says who made it; nothing is left."""
    process = start(tmp_path, "--runs", "1", "--hidden", "none")
    try:
        code = process.wait(500.0)
    finally:
        process.kill()
    printed = (tmp_path / "printed.txt").read_text()
    assert code == 0, printed
    assert "hidden: none" in printed
    path = tmp_path / "out" / "recordings" / "fit_3500V_3.5Hz.mcap"
    recording = read_recording(path)
    assert recording.drive_signal.max() == pytest.approx(3500.0)
    assert recording.valid.mean() > 0.9
    assert 0.005 < abs(recording.sin_theta[recording.valid]).max() < 0.9
    made_by = read_file(path).metadata[HEADER_RECORD]
    assert made_by["recorded_by.node"] == "/hasel/hasel_recorder"
    assert made_by["recorded_by.parameter.hasel_driver.maximum_voltage"] == "6000.0"
    assert made_by["recorded_by.parameter.hasel_simulator.model"] == "swimmer"
    assert not [
        key for key in made_by if "hasel_virtual_camera.hidden" in key
    ]  # nor would `ros2 bag info` tell
    assert not left_over(tmp_path)


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_an_interrupted_run_leaves_no_process_and_no_half_file(tmp_path):
    """Ctrl-C in the middle of a run."""
    process = start(tmp_path, "--runs", "2")
    recordings = tmp_path / "out" / "recordings"
    end = time.monotonic() + 500.0
    while not list(recordings.glob("*.part")):
        assert process.poll() is None
        assert time.monotonic() < end
        time.sleep(0.05)
    time.sleep(1.0)
    process.send_signal(signal.SIGINT)
    assert process.wait(200.0) == 0
    (kept,) = recordings.iterdir()
    assert kept.name == "fit_3500V_3.5Hz_interrupted.mcap"
    read_file(kept)  # warns, which fails the test, when it is truncated
    assert not left_over(tmp_path)


@pytest.mark.slow
@pytest.mark.timeout(3000)
def test_the_whole_loop_finds_the_hidden_effect(tmp_path):
    """Nine runs and three unseen ones, improve, the effect added live, one more run, and the secret opened."""
    process = start(tmp_path, "--hidden", "quadratic_drag")
    try:
        code = process.wait(2900.0)
    finally:
        process.kill()
    printed = (tmp_path / "printed.txt").read_text()
    assert code == 0, printed
    found = json.loads((tmp_path / "out" / "improve.json").read_text())
    assert found["stages"][-1]["effects"] == ["quadratic_drag"]
    before, after = map(float, re.search(r"live error went from (\d+\.\d+) to (\d+\.\d+)", printed).groups())
    assert after < 0.5 * before
    assert re.search(r"hidden: quadratic_drag.coefficient = [\d.]+", printed)
    names = {path.name for path in (tmp_path / "out" / "recordings").glob("*.mcap")}
    assert {"live_before.mcap", "live_after.mcap", "suggested.mcap"} <= names
    assert len([name for name in names if re.fullmatch(r"(fit|val)_\d+V_[\d.]+Hz\.mcap", name)]) == 12
    assert not left_over(tmp_path)
