"""The bar on the terminal."""

import pytest
from hasel_common import progress
from rich.progress import Progress


def shown_by(elapsed: float, done: float) -> str:
    """What is said to be left after so much time [s] with this share done."""
    clock = iter([0.0])
    bar = Progress(get_time=lambda: next(clock, elapsed), auto_refresh=False)
    task = bar.add_task("improve", total=1.0)
    bar.update(task, completed=done)
    return str(progress.TimeLeft().render(bar.tasks[0]))


@pytest.mark.parametrize(
    ("elapsed", "done", "text"),
    [(60.0, 0.25, "about 0:03:00 left"), (60.0, 1.0, "about 0:00:00 left"), (60.0, 0.01, "")],
)
def test_what_is_left_goes_by_all_that_was_done(elapsed, done, text):
    """Not by the last step; nothing is told before a fiftieth is done."""
    assert shown_by(elapsed, done) == text


def test_the_bar_never_goes_back():
    """A search that finds more to do stays where it is until that is done; what is beyond the ends is cut."""
    seen = []
    show = progress.never_back(lambda text, share: seen.append(share))
    for share in (0.06, 0.04, 0.5, -1.0, 2.0):
        show("step", share)
    assert seen == [0.06, 0.06, 0.5, 0.5, 1.0]


def test_a_log_has_a_line_for_every_stage(capsys):
    """With the time so far and what is left; within a stage one each ten seconds."""
    clock = iter([0.0, 10.0, 11.0, 30.0, 39.0, 95.0])
    show = progress.log_lines("improve", lambda: next(clock))
    for text, share in (
        ("start: simulated run_1", 0.01),
        ("start: simulated run_2", 0.02),
        ("baseline: horizon 1 of 8", 0.1),
        ("baseline: horizon 2 of 8", 0.2),
        ("baseline: horizon 3 of 8", 0.5),
    ):
        show(text, share)
    assert capsys.readouterr().err.splitlines() == [
        "improve: start: simulated run_1 (1%, 0:00:10 so far)",
        "improve: baseline: horizon 1 of 8 (10%, 0:00:30 so far, about 0:04:30 left)",
        "improve: baseline: horizon 3 of 8 (50%, 0:01:35 so far, about 0:01:35 left)",
    ]


def test_what_is_no_terminal_gets_lines(capsys):
    """A log of a cluster or a pipe is not left without a word."""
    with progress.progress_bar("fit") as show:
        show("low-fidelity model", 0.2)
    assert capsys.readouterr().err.startswith("fit: low-fidelity model (20%, 0:00:00 so far")


def test_counted_steps_are_said_each_ten_seconds_only(capsys):
    """How many of how many, and how long the rest takes; nothing of what is soon done."""
    clock = iter([0.0, 0.1, 9.0, 10.5, 15.0, 21.0])
    show = progress.log_lines("tracking", lambda: next(clock))
    for frame in (1, 90, 105, 150, 210):
        show(f"tracking: {frame} of 400 frames", frame / 400)
    assert capsys.readouterr().err.splitlines() == [
        "tracking: 105 of 400 frames (26%, 0:00:10 so far, about 0:00:30 left)",
        "tracking: 210 of 400 frames (52%, 0:00:21 so far, about 0:00:19 left)",
    ]


@pytest.mark.parametrize(("total", "shown"), [(3, "3 of 3 frames"), (None, "3 frames")])
def test_a_bar_counts_its_steps(monkeypatch, total, shown):
    """Also where nobody knows how many there are."""
    seen = []
    monkeypatch.setattr(progress, "log_lines", lambda title: lambda text, share: seen.append((text, share)))
    with progress.counted("tracking", "frames", total) as done:
        for number in (1, 2, 3):
            done(number)
    assert seen[-1] == (f"tracking: {shown}", 1.0 if total else 0.0)
