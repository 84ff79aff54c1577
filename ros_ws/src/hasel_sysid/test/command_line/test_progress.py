"""The bar on the terminal."""

import pytest
from hasel_sysid.command_line import progress
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
    """With the time so far and what is left; within a stage one a minute."""
    clock = iter([0.0, 10.0, 11.0, 30.0, 40.0, 95.0])
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
