# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a command took."""

import subprocess
import sys

import pytest
from hasel_benchmark.bench_cluster import BAR, Work
from hasel_benchmark.errors import BenchmarkError
from hasel_benchmark.process_cost import Took, Watched, timed


def test_a_command_is_timed_and_one_that_fails_is_told():
    """With the processor time that the workers used meanwhile."""
    used = iter((1.0, 3.5))
    took = timed("platform", [], lambda: next(used))
    assert took.workers_s == 2.5
    assert 0 < took.command_s <= took.wall_s + 0.1
    with pytest.raises(BenchmarkError, match=r"gave 1: .*No module named"):
        timed("hasel_nothing", [], lambda: 0.0)


def test_the_middle_of_the_rounds_is_judged():
    """Against the bar."""
    of = {1: [Took(wall, 1.0, 1.0) for wall in (20.0, 18.0, 90.0)], 2: [Took(10.0, 1.0, 1.0)] * 3}
    bar = Work("improve", "", (), of).bar()
    assert bar.measured == 2.0
    assert bar.met == (BAR <= 2.0)


def test_what_processes_of_processes_take_is_seen():
    """Memory at once, and processor time, also of those that nobody waited for."""
    busy = (
        "a = b'1' * 200_000_000; begin = time.process_time()\nwhile time.process_time() < begin + 1.5: pass"
    )
    inner = f"import time; {busy}"
    outer = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {inner!r}])"
    with Watched() as watched:
        subprocess.run([sys.executable, "-c", outer], check=True)
    assert 200e6 < watched.peak_bytes < 400e6
    assert 0.8 < watched.processor_s < 3.0
