"""The loop in a made-up world, where it is known what every effect does."""

import pytest
from hasel_sysid.improve import Status, improve
from hasel_sysid.testing.made_up_world import MadeUpWorld


def improved(hidden, stranger=0.0, most_effects=3, seed=1):
    """What is found when these effects, of typical size, and a stranger of so much rms are hidden."""
    world = MadeUpWorld(seed, shared=16)
    truth = world.with_typical(*hidden)
    return improve(world.measured(truth, stranger=stranger), world.model, most_effects=most_effects)


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
