"""What effects are given: made when they ask for it, and lane by lane where they look at the drive."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.mechanics.laws import by_group, grouped, on_demand


@dataclass(frozen=True)
class Points:
    """A position, and the drive."""

    position: np.ndarray
    time: float


LAZY = on_demand(Points, ("time",))


def test_what_is_not_asked_for_is_not_made():
    """What was made is kept; a look at the drive is noted."""
    made = []
    points = LAZY({}, lambda name: made.append(name) or len(made))
    assert isinstance(points, Points)
    assert (points.position, points.position) == (1, 1)
    assert made == ["position"]
    assert not points.looked
    assert points.time == 2
    assert points.looked


def test_an_unknown_attribute_is_named_with_the_nearest():
    """As a typing error in an effect of one's own."""
    with pytest.raises(AttributeError, match=r"Points has no 'positon'.*position"):
        _ = LAZY({}, lambda name: 0.0).positon


def test_lanes_with_the_same_values_are_asked_at_once_unless_they_must_not():
    """Lane 2 lacks the effect and gets zero; an answer of None asks the lanes of a group one by one."""
    first, other = SimpleNamespace(size=1.0), SimpleNamespace(size=2.0)
    groups, asked = grouped([first, other, None, first]), []

    def ask(lanes, values):
        asked.append(lanes.tolist())
        if len(lanes) > 1:
            return None
        return np.full((2 * 5, 2), values.size * (1 + lanes[0]))

    found = by_group(groups, (2, 4, 5, 2), ask)
    assert asked == [[0, 3], [0], [3], [1]]
    assert found[:, :, 0, 0].tolist() == [[1.0, 4.0, 0.0, 4.0]] * 2
