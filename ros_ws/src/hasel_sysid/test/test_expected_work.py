# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The time left that `improve` tells, on recorded timings of whole searches.

`timings/improve.csv`: when stages began and simulations ended, from searches of nine runs by two processes on a machine
that had other work, too.
"""

import csv
from contextlib import ExitStack
from dataclasses import replace
from itertools import groupby
from pathlib import Path

import pytest
from hasel_common.progress import HowFar, Stage, Workload
from hasel_sysid.command_line.options import improve_parser
from hasel_sysid.expected_work import TYPICAL, USUAL_SPEED, TimeLimit, plan_of_improve

TIMINGS = Path(__file__).with_name("timings") / "improve.csv"
SIZE = 4014.0
"""Work of one simulation of the nine runs: 240 steps per second of 16.7 s."""
CANDIDATES = 31
TABLE_FROM = (
    "nothing missing, unseen rig",
    "nothing missing",
    "one effect, charging lag",
    "one effect, muscle asymmetry",
    "one strong effect, charging lag",
    "two effects, drag and asymmetry",
    "two effects, creep and latency",
    "out of the catalogue, cubic drag",
)
"""By these the table of `expected_work` was made."""
KEPT_ASIDE = (
    "one effect, quadratic drag",
    "one effect, structural damping",
    "one effect, gain drift",
    "out of the catalogue, one-sided dead zone",
)
"""The table knows nothing of these."""
LONG_WITHOUT_NOTICE = "two effects, lag and modulus"
"""Kept aside, too: until 36 % of its time nothing tells that no effect alone will do."""
EVERY = (*TABLE_FROM, *KEPT_ASIDE, LONG_WITHOUT_NOTICE)


def recorded(case: str) -> list[dict[str, str]]:
    """The rows of a case, in order of time."""
    with TIMINGS.open(newline="") as file:
        return [row for row in csv.DictReader(file) if row["case"] == case]


def told_at(case: str, share: float) -> tuple[HowFar, float]:
    """What was told after this share of the whole time, and the time that was really left [s]."""
    rows = recorded(case)
    end = float(rows[-1]["time_s"])
    time_s = [0.0]
    work = Workload(plan_of_improve(SIZE, CANDIDATES), usual_speed=USUAL_SPEED, clock=lambda: time_s[0])
    stage = ExitStack()
    for row in rows:
        if float(row["time_s"]) > share * end:
            break
        time_s[0] = float(row["time_s"])
        if row["stage"]:
            stage.close()
            stage.enter_context(work.stage(_known(Stage(row["stage"]))))
        for _ in range(int(row["simulations"] or 0)):
            work.did(float(row["work"]) / int(row["simulations"]))
    time_s[0] = share * end
    return work.now(), (1.0 - share) * end


def _known(stage: Stage) -> Stage:
    """As the search begins it: how many typical sizes there are is known."""
    return replace(stage, work=24.2 * SIZE, known=True) if stage.text == TYPICAL.text else stage


@pytest.mark.parametrize("case", [*TABLE_FROM, *KEPT_ASIDE])
def test_the_time_left_is_right_within_a_factor_of_two_after_a_third(case):
    """Whatever is missing, and however long it takes to be found."""
    told, left_s = told_at(case, 1 / 3)
    assert told.left_s is not None
    assert 0.5 < told.left_s / left_s < 2.0


def test_a_search_that_turns_out_to_be_long_is_told_so_at_once():
    """A third of what was left was told before, the whole within a factor of two after."""
    before, left_s = told_at(LONG_WITHOUT_NOTICE, 1 / 3)
    assert before.left_s is not None
    assert 0.25 < before.left_s / left_s < 0.5
    after, left_s = told_at(LONG_WITHOUT_NOTICE, 0.37)
    assert after.left_s is not None
    assert 0.5 < after.left_s / left_s < 2.0


@pytest.mark.parametrize("case", EVERY)
def test_the_whole_time_stays_right_within_a_factor_of_two_from_then_on(case):
    """What has passed and what is said to be left; late in a search the latter alone may be further off."""
    for percent in range(34, 100, 3):
        told, left_s = told_at(case, percent / 100)
        passed_s = left_s * percent / (100 - percent)
        assert told.left_s is not None
        assert 0.5 < (passed_s + told.left_s) / (passed_s + left_s) < 2.0, f"at {percent} %"


@pytest.mark.parametrize("case", EVERY)
def test_something_is_told_within_five_seconds(case):
    """Before any simulation has ended by what usual machines do, then by what was measured."""
    seconds = float(recorded(case)[-1]["time_s"])
    told, _ = told_at(case, 5.0 / seconds)
    assert told.left_s is not None
    assert told.left_s > 0


def test_the_recorded_cases_are_unlike():
    """From twenty seconds to minutes, from few hundred simulations to many thousand; each has an end."""
    with TIMINGS.open(newline="") as file:
        cases = {name: list(rows) for name, rows in groupby(csv.DictReader(file), lambda row: row["case"])}
    counts = [sum(int(row["simulations"] or 0) for row in rows) for rows in cases.values()]
    assert set(cases) == set(EVERY)
    assert max(counts) > 5 * min(counts)
    assert all(rows[-1]["stage"] == "end" for rows in cases.values())


def test_it_is_over_after_so_many_seconds_and_remembers_that_it_mattered():
    """Of a clock of its own; nobody who did not ask was held up by it."""
    now = [100.0]
    limit = TimeLimit(5.0, clock=lambda: now[0])
    now[0] = 104.9
    assert not limit.is_over()
    now[0] = 105.1
    assert not limit.left_something_out
    assert limit.is_over()
    assert limit.left_something_out
    assert str(limit) == "the limit of 5 s"


def test_work_is_done_in_batches_until_it_is_over():
    """Nothing is lost while there is time; the batch that is being done is the last once time is over."""
    now = [0.0]
    limit = TimeLimit(5.0, clock=lambda: now[0])
    assert [piece for batch in limit.in_batches(range(20)) for piece in batch] == list(range(20))
    done = []
    for batch in limit.in_batches(range(20)):
        done += batch
        now[0] += 3.0
    assert done == list(range(16))


def test_the_first_batch_may_be_done_in_any_case():
    """Where time is over before anything began: the first alone, or none."""
    limit = TimeLimit(5.0, clock=iter([0.0, 6.0, 6.0]).__next__)
    assert list(limit.in_batches("abc")) == []
    assert list(limit.in_batches("abcdefghij", even_late=True)) == ["abcdefgh"]


def test_it_is_an_option_that_must_be_positive(capsys):
    """None by default; nothing and less are refused."""
    assert improve_parser().parse_args(["run.csv"]).seconds == float("inf")
    assert improve_parser().parse_args(["run.csv", "--seconds", "90"]).seconds == 90.0
    for refused in ("0", "-3", "soon"):
        try:
            improve_parser().parse_args(["run.csv", "--seconds", refused])
        except SystemExit as error:
            assert error.code == 2
    assert capsys.readouterr().err.count("--seconds") >= 3
