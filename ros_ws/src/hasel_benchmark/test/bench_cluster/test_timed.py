"""What a command took."""

import pytest
from hasel_benchmark.bench_cluster.command import BAR, Work
from hasel_benchmark.bench_cluster.timed import Took, timed
from hasel_benchmark.errors import BenchmarkError


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
