"""What the cost of `improve` is measured on, and how it is judged."""

import subprocess
import sys

import pytest
from hasel_benchmark.bench_recordings.command import Cost, bars_of, boxes, line
from hasel_benchmark.bench_recordings.watched import Watched
from hasel_benchmark.errors import BenchmarkError


@pytest.mark.parametrize("number", [1, 10, 30, 100, 102])
def test_recordings_are_as_many_as_asked_for_and_all_different(number):
    """At the voltages of the plan, so that no more amplitudes are to be fitted."""
    runs = boxes(number)
    assert len({run.name for run in runs}) == number
    assert {run.voltage for run in runs} <= {3500.0, 4500.0, 5500.0}


def test_more_recordings_than_there_are_is_an_error():
    """With what there is."""
    with pytest.raises(BenchmarkError, match="103 recordings were asked for; expected 1 to 102"):
        boxes(103)


def test_a_cost_that_grows_faster_than_what_was_recorded_misses_the_bar():
    """And so does memory beyond its bar."""
    first, last = Cost(10, 20.0, 10.0, 20.0, 1.0), Cost(100, 200.0, 99.0, 201.0, 4.5)
    assert [bar.met for bar in bars_of([first, last])] == [False, False]
    assert [bar.met for bar in bars_of([first, Cost(100, 200.0, 99.0, 150.0, 3.9)])] == [True, True]
    assert line(last) == "| 100 | 200 | 99 | 201 | 1.00 | 4.5 |"


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
