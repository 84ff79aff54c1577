"""By which sum of squares an effect is judged."""

from types import SimpleNamespace

from hasel_sysid.diagnosis.reached import squares_reached

BASE = 10.0


def trial(name: str, predicted: float, promised: float):
    """A trial that would come to `predicted` with its next step."""
    start = SimpleNamespace(effect=SimpleNamespace(id=name))
    return SimpleNamespace(start=start, predicted=predicted, sum_of_squares=9.0, promised=promised)


def fit(squares: float):
    """A full fit."""
    return SimpleNamespace(evaluation=SimpleNamespace(sum_of_squares=squares))


def test_with_time_for_everything_each_is_judged_by_what_it_reached():
    """A promise that was not kept says nothing."""
    found = squares_reached(
        [trial("drag", 5.0, 9.5), trial("damping", 3.0, 8.0)], {"damping": fit(2.0)}, BASE, False
    )
    assert found == {"drag": 5.0, "damping": 2.0}


def test_what_had_no_turn_is_judged_by_what_it_promises():
    """The one that was fitted in full is judged by its fit, and is not surely the one that is missing."""
    found = squares_reached(
        [trial("drag", 5.0, 9.5), trial("damping", 3.0, 8.0)], {"damping": fit(2.0)}, BASE, True
    )
    assert found == {"drag": 0.5, "damping": 2.0}
