"""How far a work has come, by what was counted and by what its stages usually take."""

import pytest
from hasel_common.workload import Stage, Workload

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
