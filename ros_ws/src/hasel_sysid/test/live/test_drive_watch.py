"""Runs and rests, state by state."""

import pytest
from hasel_sysid.live.drive_watch import DriveWatch

_S = 1_000_000_000
ON, OFF = (0.0, -4000.0), (0.0, 0.0)


@pytest.fixture
def watch():
    """Driven from 3 s to 5 s."""
    watch = DriveWatch()
    assert not watch.begins(0, 0, OFF)
    assert watch.begins(0, 3 * _S, ON)
    assert not watch.begins(0, 5 * _S, OFF)
    return watch


def test_a_run_is_over_a_second_after_its_drive(watch):
    """What rings after it still belongs to it; before the first run nothing is over."""
    assert [watch.is_over(0, round(t * _S)) for t in (1.0, 4.0, 5.5, 6.0, 6.1, 60.0)] == [False] * 4 + [
        True
    ] * 2


def test_a_frame_of_the_rest_may_come_after_the_next_start(watch):
    """Angles come later than states."""
    assert watch.begins(0, 9 * _S, ON)
    assert watch.is_over(0, 8 * _S)
    assert not watch.is_over(0, 9 * _S)


def test_a_short_rest_is_none(watch):
    """Of a drive with pauses."""
    assert not watch.begins(0, 7 * _S, ON)


def test_a_voltage_holds_until_the_next_state():
    """States that come only when something changes: a body that is held bent is driven all the time."""
    watch = DriveWatch()
    watch.begins(0, 0, ON)
    assert not watch.is_over(0, 30 * _S)
    assert not watch.begins(0, 31 * _S, ON)


def test_another_epoch_knows_nothing_of_the_last(watch):
    """Stamps that went back are of another run."""
    assert not watch.begins(1, 0, OFF)
    assert not watch.is_over(1, 60 * _S)
    assert watch.begins(1, 3 * _S, ON)


def test_an_unknown_voltage_begins_no_run():
    """A supply in FAULT says NaN."""
    assert not DriveWatch().begins(0, 0, (float("nan"), 0.0))
