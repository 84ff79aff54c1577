"""The bar on the terminal, and the lines of a log."""

import io
import time

import pytest
from hasel_common import progress
from hasel_common.progress import LogLines, counted, progress_bar
from hasel_common.workload import HowFar, Stage, Workload


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
    console = progress.Console
    monkeypatch.setattr(
        progress, "Console", lambda stderr: console(file=shown, force_terminal=True, width=120)
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
