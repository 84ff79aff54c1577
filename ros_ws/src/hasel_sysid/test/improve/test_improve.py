"""The loop in a made-up world, where it is known what every effect does."""

import math

import pytest
from hasel_sysid.diagnosis import Verdict
from hasel_sysid.improve import Status, improve
from hasel_sysid.testing.made_up_world import MadeUpWorld


def improved(hidden, stranger=0.0, most_effects=3, seed=1, most_evaluations=math.inf):
    """What is found when these effects, of typical size, and a stranger of so much rms are hidden."""
    world = MadeUpWorld(seed, shared=16)
    truth = world.with_typical(*hidden)
    return improve(
        world.measured(truth, stranger=stranger, most_evaluations=most_evaluations),
        world.model,
        most_effects=most_effects,
    )


@pytest.mark.parametrize(
    "hidden", [("payload",), ("quadratic_drag", "drive_creep"), ("slow_creep", "pre_bend", "gravity_tilt")]
)
def test_what_is_hidden_is_named(hidden):
    """One, two or three effects, and nothing beside them."""
    found = improved(hidden)
    assert set(found.missing) == set(hidden)
    assert found.status is Status.EXPLAINED


def test_a_stranger_is_not_explained():
    """What no effect does is not called explained, whatever imitates a part of it."""
    assert improved((), stranger=0.02).status in (Status.UNEXPLAINED, Status.PARTLY_EXPLAINED)


def test_the_number_of_effects_is_kept_to():
    """Three are hidden, two may be added: the search says that it ends there and does not call it explained."""
    found = improved(("slow_creep", "pre_bend", "gravity_tilt"), most_effects=2)
    assert len(found.stages[-1].effects) <= 2
    assert found.status is not Status.EXPLAINED


def test_a_search_whose_time_is_over_ends_in_good_order():
    """From no time at all to enough: it says what it had no time for, and never that this is absent."""
    hidden = ("quadratic_drag", "drive_creep")
    found = [improved(hidden, most_evaluations=most) for most in (0, 20, 40, math.inf)]
    for one in found[:3]:
        assert "The search ended at the limit" in one.reason
        assert one.status is not Status.EXPLAINED or set(one.missing) == set(hidden)
    for one in found[:2]:
        untried = [f for f in one.diagnosis.findings if f.verdict is Verdict.NOT_TRIED]
        assert untried
        assert {f.effect for f in untried} <= set(one.not_tried)
        assert all("was not tried" in str(f) for f in untried)
        assert untried[0].effect in one.reason
    assert len(found[0].not_tried) > len(found[1].not_tried) > len(found[2].not_tried)
    assert set(found[3].missing) == set(hidden)
    assert "The search ended" not in found[3].reason
    assert found[3].not_tried == []
