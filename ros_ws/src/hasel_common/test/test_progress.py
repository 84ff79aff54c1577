# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How far a work has come, by what was counted and by what its stages usually take: a bar, and the lines of a log."""

import io
import time

import pytest
import rich.console
from hasel_common import progress
from hasel_common.progress import HowFar, LogLines, Stage, Workload, counted, progress_bar

FIT, SEARCH = Stage("fit", 10.0), Stage("search", 30.0)
RARE, AS_RARE = Stage("more", 100.0, chance=0.1), Stage("most", 50.0, chance=0.1)


class Clock:
    """Tells the time [s] that it was set to."""

    def __init__(self) -> None:
        self.time_s = 0.0

    def __call__(self) -> float:
        return self.time_s


@pytest.fixture
def clock() -> Clock:
    """At 0 s."""
    return Clock()


def test_the_time_left_goes_by_the_speed_that_was_measured(clock):
    """Nine in 9 s; the fit goes on although all its ten are done: a quarter of it, and the 30 of the search."""
    work = Workload([FIT, SEARCH, RARE], clock=clock)
    with work.stage(FIT):
        for clock.time_s in range(10):
            work.did()
        now = work.now()
    assert now.left_s == pytest.approx(2.5 + 30.0)
    assert (now.done, now.of) == (10, 42)


def test_what_passes_before_the_first_piece_is_done_is_no_speed(clock):
    """The start of processes does not make the work slow."""
    work = Workload([FIT], clock=clock)
    with work.stage(FIT):
        for clock.time_s in (60.0, 61.0, 62.0):
            work.did()
        assert work.now().left_s == pytest.approx(7.0)


def test_there_is_an_estimate_before_anything_was_measured(clock):
    """By the usual speed, where one is known; else none."""
    assert Workload([FIT], usual_speed=2.0, clock=clock).now().left_s == pytest.approx(5.0)
    assert Workload([FIT], clock=clock).now().left_s is None
    assert Workload(clock=clock).now().left_s is None


def test_what_is_rare_is_expected_once_it_is_reached():
    """With all that is as rare; the share does not go back."""
    work = Workload([FIT, RARE, SEARCH, AS_RARE])
    with work.stage(FIT):
        for _ in range(10):
            work.did()
    before = work.now()
    with work.stage(RARE):
        after = work.now()
    assert (before.of, after.of) == (40, 190)
    assert before.share == after.share == pytest.approx(0.25)


def test_what_often_comes_is_expected_by_its_chance():
    """Six tenths of it; what comes in fewer than one case of three would make every other look long."""
    work = Workload([FIT, Stage("often", 20.0, chance=0.6), RARE])
    with work.stage(FIT):
        work.did()
        assert work.now().of == 10 + 12


def test_between_two_stages_the_last_one_is_told():
    """Nobody is left without a word of what it is about."""
    work = Workload([FIT, SEARCH])
    with work.stage(FIT), work.stage(Stage("low-fidelity model")):
        work.did()
    assert work.now().stage == "fit"


def test_a_stage_that_goes_on_beyond_its_usual_work_is_not_yet_at_its_end():
    """A quarter of it is expected still; nothing of one that is known, nor after the last one."""
    usual, known = Workload([FIT]), Workload([Stage("fit", 10.0, known=True)])
    for work in (usual, known):
        with work.stage(Stage("fit", 10.0, known=work is known)):
            for _ in range(20):
                work.did()
            assert work.now().of == (20 if work is known else 22)
            assert work.now().certain == (work is known)
        assert work.now().share == 1.0


def test_what_is_known_of_a_stage_goes_before_what_it_usually_takes():
    """As many as are counted at its begin."""
    work = Workload([FIT, SEARCH])
    with work.stage(Stage("search", 4.0, known=True)):
        work.did()
        assert (work.now().done, work.now().of, work.now().certain) == (1, 4, True)


def test_a_stage_within_another_lends_its_text_only():
    """What is expected stays that of the outer one."""
    work = Workload([FIT, SEARCH])
    with work.stage(FIT):
        work.did()
        with work.stage(SEARCH):
            assert str(work.now()).startswith("fit: search, 1 of about 40 simulations")
        assert work.now().stage == "fit"


def test_who_no_longer_wants_the_work_breaks_it_off():
    """At the next stage, or between two pieces, by what it is told with."""
    said = []

    def tell(text: str, share: float) -> None:
        said.append((text, share))
        if len(said) == 2:
            raise KeyboardInterrupt

    work = Workload([FIT], tell=tell)
    with pytest.raises(KeyboardInterrupt), work.stage(FIT):
        work.did(5.0)
        work.check()
    assert said == [("fit", 0.0), ("fit, 1 of about 2 simulations", 0.5)]


def far(stage: str, done: int = 0, left_s: float | None = None) -> HowFar:
    """Of a hundred simulations."""
    return HowFar(stage, done, 100, False, "simulations", done / 100, left_s)


def lines_of(looks: list[tuple[float, HowFar]], title: str = "improve") -> list[str]:
    """What is said where somebody looks at these times [s]."""
    clock, states, said = iter([0.0, *(at for at, _ in looks)]), iter([each for _, each in looks]), []
    lines = LogLines(title, lambda: next(states), said.append, lambda: next(clock))
    for _ in looks:
        lines.look()
    return said


def test_a_log_has_a_line_for_every_stage_and_one_each_ten_seconds():
    """What, how many of how many, the time left, the share and the time so far."""
    assert lines_of(
        [
            (0.5, far("start", 1)),
            (1.0, far("start", 2, 99.0)),
            (10.4, far("start", 5, 95.0)),
            (10.6, far("start", 6, 90.0)),
            (11.0, far("fit: horizon 1 of 8", 7, 80.0)),
            (21.5, far("fit: horizon 1 of 8", 7, 70.0)),
        ]
    ) == [
        "improve: start, 1 of about 100 simulations (1%, 0:00:00 so far)",
        "improve: start, 6 of about 100 simulations, about 0:01:30 left (6%, 0:00:11 so far)",
        "improve: fit: horizon 1 of 8, 7 of about 100 simulations, about 0:01:20 left (7%, 0:00:11 so far)",
        "improve: fit: horizon 1 of 8, 7 of about 100 simulations, about 0:01:10 left (7%, 0:00:22 so far)",
    ]


def test_a_line_names_the_work_once():
    """Where its first stage has the same name, too."""
    assert lines_of([(1.0, far("fit: the model itself", 3))], "fit") == [
        "fit: the model itself, 3 of about 100 simulations (3%, 0:00:01 so far)"
    ]


def test_the_first_line_comes_within_five_seconds():
    """Also where no stage has begun so far."""
    looks = [(0.5 * number, far("", 0, 30.0)) for number in range(1, 12)]
    assert lines_of(looks) == ["improve: about 0:00:30 left (0:00:04 so far)"]


def test_a_log_hears_of_a_stage_that_says_nothing(capsys, monkeypatch):
    """Somebody looks from a thread of his own while the work is at one thing."""
    monkeypatch.setattr(progress, "_LINE_EVERY_S", 0.2)
    monkeypatch.setattr(progress, "_LOOK_EVERY_S", 0.02)
    stage = Stage("fit", 10.0)
    with progress_bar("improve", [stage]) as work, work.stage(stage):
        for _ in range(3):
            work.did()
        time.sleep(1.0)
    said = capsys.readouterr().err.splitlines()
    assert len(said) >= 3
    assert all(line.startswith("improve: fit, 3 of about 10 simulations") for line in said)


def test_a_terminal_has_a_bar_with_what_is_counted(monkeypatch):
    """Stage, how many of how many, and the time left."""
    shown = io.StringIO()
    console = rich.console.Console
    monkeypatch.setattr(
        rich.console, "Console", lambda stderr: console(file=shown, force_terminal=True, width=120)
    )
    stage = Stage("fit", 10.0)
    with progress_bar("improve", [stage]) as work, work.stage(stage):
        for _ in range(5):
            work.did()
        time.sleep(1.2)
    assert "fit, 5 of about 10 simulations, about 0:00:0" in shown.getvalue()
    assert "50%" in shown.getvalue()


@pytest.mark.parametrize(
    ("total", "shown"), [(400, "tracking, 105 of 400 frames"), (None, "tracking, 105 frames")]
)
def test_a_bar_counts_its_steps(monkeypatch, total, shown):
    """How many of how many, also where nobody knows how many there are."""
    works = []
    monkeypatch.setattr(progress, "Workload", lambda *given: works.append(Workload(*given)) or works[0])
    with counted("tracking", "frames", total) as done:
        for frame in (1, 90, 105):
            done(frame)
        assert str(works[0].now()).startswith(shown)


def test_counted_steps_are_said_under_the_title_only():
    """Nothing at their begin; how long the rest takes."""
    looks = [(0.5, far("tracking", 1)), (4.5, far("tracking", 9, 45.0))]
    assert lines_of(looks, "tracking") == [
        "tracking, 9 of about 100 simulations, about 0:00:45 left (9%, 0:00:04 so far)"
    ]
