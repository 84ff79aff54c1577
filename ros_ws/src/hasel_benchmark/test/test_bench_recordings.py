# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the cost of `improve` is measured on, and how it is judged."""

import pytest
from hasel_benchmark.bench_recordings import Cost, bars_of, boxes, line
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
