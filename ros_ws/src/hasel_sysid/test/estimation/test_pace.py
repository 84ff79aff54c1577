"""Whether a search goes on to where it is worth anything."""

import pytest
from hasel_sysid.estimation.pace import Pace


def _nowhere(squares: list[float], goal: float, most: int = 25, foretold: float = 0.0) -> list[bool]:
    """What is said after every step of a search of one evaluation each."""
    pace = Pace(goal, most)
    return [pace.leads_nowhere(value, count, lambda: foretold) for count, value in enumerate(squares, 1)]


def test_a_search_that_creeps_far_above_its_goal_leads_nowhere():
    """A hundredth a step, twenty times, is a fifth."""
    assert _nowhere([30.0, 29.7, 29.4], goal=0.08) == [False, False, True]


def test_one_short_step_tells_nothing():
    """It may have been held back, as the second of these was."""
    assert not any(_nowhere([100.0, 10.0, 9.9, 1.0, 0.1], goal=0.08))


def test_one_short_step_is_enough_where_the_next_one_whole_would_not_lead_there_either():
    """What held it back was not the length of its step."""
    squares = [100.0, 10.0, 9.9]
    assert _nowhere(squares, goal=1.0, foretold=0.9) == [False, False, False]
    assert _nowhere(squares, goal=1.0, foretold=9.8) == [False, False, True]


def test_what_first_order_does_not_foretell_is_reached_at_a_good_pace():
    """Of a way that bends it sees the beginning only."""
    assert not any(_nowhere([100.0, 60.0, 30.0, 10.0], goal=1.0, foretold=9.8))


def test_a_search_that_is_fast_enough_goes_on():
    """A third less in every step is a thousandth after 17."""
    assert not any(_nowhere([30.0 * 0.67**n for n in range(8)], goal=0.08))


def test_the_same_pace_is_too_slow_with_few_evaluations_left():
    """What counts is where it would be when they are used up."""
    squares = [30.0 * 0.67**n for n in range(8)]
    assert _nowhere(squares, goal=0.08, most=10)[-1]


@pytest.mark.parametrize("goal", [0.0, 32.0, 160.0])
def test_what_is_below_its_goal_or_has_none_goes_to_its_end(goal):
    """Which of two is likelier, the last digits tell."""
    assert not any(_nowhere([30.0, 29.7, 29.6, 29.59], goal))


def test_a_refused_step_counts_for_the_pace_of_the_next():
    """Two evaluations for a quarter less, of which seven are left, do not lead to a tenth."""
    pace = Pace(goal=1.0, most=12)
    assert not pace.leads_nowhere(16.0, 1, float)
    assert not pace.leads_nowhere(12.0, 3, float)
    assert pace.leads_nowhere(9.0, 5, float)
