# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""All benchmarks one after the other, and what a command uses until it has done its work."""

import subprocess
import sys

import pytest
from hasel_bringup import bench_all, processes
from hasel_bringup.errors import BringupError


def test_counts_the_process_s_own_time_and_memory():
    """A second of processor time and 300 MB are seen; sleeping costs nothing."""
    idle = bench_all.used_by([sys.executable, "-c", "import time; time.sleep(0.3)"])
    work = "import time\nwhile time.process_time() < 1.0: pass\nkept = b'x' * 300_000_000"
    busy = bench_all.used_by([sys.executable, "-c", work])
    assert busy.seconds >= 1.0
    assert idle.seconds < 0.5
    assert busy.megabytes > 280


def test_a_command_that_fails_is_no_measurement():
    """Nobody takes an error at once for a quick start."""
    with pytest.raises(subprocess.CalledProcessError):
        bench_all.used_by([sys.executable, "-c", "raise SystemExit(3)"])


@pytest.mark.parametrize(
    ("seconds", "megabytes", "met"), [(0.2, 100.0, True), (0.6, 100.0, False), (0.2, 400.0, False)]
)
def test_bars(seconds, megabytes, met, monkeypatch, capsys, tmp_path):
    """Each measured figure stands beside its bar, and the result says whether all are met."""
    (tmp_path / "a.csv").touch()
    monkeypatch.setattr(bench_all, "COMPARED", tmp_path)
    monkeypatch.setattr(bench_all, "least_used", lambda command: bench_all.Used(seconds, megabytes))
    assert bench_all.measure_start_up() is met
    said = capsys.readouterr().out
    assert ("MISSED" in said) is not met
    assert "compare of 1 runs" in said


@pytest.fixture
def installed(monkeypatch, tmp_path):
    """Stand-ins for the three packages' executables, each writing its name and returning a code of its own."""
    codes = {"hasel_sim": 0, "hasel_driver": 2, "hasel_tracker_lab": 0}
    for package, code in codes.items():
        path = tmp_path / "lib" / package / "bench"
        path.parent.mkdir(parents=True)
        path.write_text(f"#!/bin/sh\necho bench of {package}\nexit {code}\n")
        path.chmod(0o755)
    monkeypatch.setattr(processes, "get_package_prefix", lambda package: str(tmp_path))
    monkeypatch.setattr(bench_all, "measure_start_up", lambda: print("bench of starting") or True)
    return tmp_path


def test_runs_all_even_if_one_misses_its_bars(installed, capfd):
    """The driver misses a bar: the tracker is measured all the same, and the exit code tells."""
    assert bench_all.main([]) == 2
    lines = capfd.readouterr().out.split("\n")
    assert [line for line in lines if line.startswith("bench of")] == [
        "bench of hasel_sim",
        "bench of hasel_driver",
        "bench of hasel_tracker_lab",
        "bench of starting",
    ]


def test_missing_executable_is_one_sentence(installed):
    """What is not built is named, with what to do."""
    (installed / "lib" / "hasel_driver" / "bench").unlink()
    with pytest.raises(BringupError, match=r"hasel_driver has no executable bench.*make build"):
        bench_all.bench_executable("hasel_driver")
