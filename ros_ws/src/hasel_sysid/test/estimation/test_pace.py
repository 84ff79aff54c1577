"""Whether a search goes on to be compared with another model."""

import pytest
from hasel_sysid.estimation.pace import Pace


def _nowhere(squares: list[float], against: float, most: int = 25) -> list[bool]:
    """What is said after every step of a search of one evaluation each."""
    pace = Pace(against, most)
    return [pace.leads_nowhere(value, count) for count, value in enumerate(squares, 1)]


def test_a_search_that_creeps_a_thousand_times_above_another_model_leads_nowhere():
    """A hundredth a step, twenty times, is a fifth."""
    assert _nowhere([30.0, 29.7, 29.4], against=0.02) == [False, False, True]


def test_one_short_step_tells_nothing():
    """It may have been held back, as the second of these was."""
    assert not any(_nowhere([100.0, 10.0, 9.9, 1.0, 0.1], against=0.02))


def test_a_search_that_is_fast_enough_goes_on():
    """A third less in every step is a thousandth after 17."""
    assert not any(_nowhere([30.0 * 0.67**n for n in range(8)], against=0.02))


def test_the_same_pace_is_too_slow_with_few_evaluations_left():
    """What counts is where it would be when they are used up."""
    squares = [30.0 * 0.67**n for n in range(8)]
    assert _nowhere(squares, against=0.02, most=10)[-1]


@pytest.mark.parametrize("against", [0.0, 8.0, 40.0])
def test_what_is_near_the_other_model_or_has_none_goes_to_its_end(against):
    """Which of two is likelier, the last digits tell."""
    assert not any(_nowhere([30.0, 29.7, 29.6, 29.59], against))


def test_a_refused_step_counts_for_the_pace_of_the_next():
    """Two evaluations for a quarter less, of which seven are left, do not lead to a tenth."""
    pace = Pace(against=0.25, most=12)
    assert not pace.leads_nowhere(16.0, 1)
    assert not pace.leads_nowhere(12.0, 3)
    assert pace.leads_nowhere(9.0, 5)
