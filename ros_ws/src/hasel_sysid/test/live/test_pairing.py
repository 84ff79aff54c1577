"""Pairs by stamp, by interpolation, and not at all."""

import math

import pytest
from hasel_sysid.live.epochs import Epochs, StreamEpoch
from hasel_sysid.live.pairing import Pair, Pairing

_FRAME = 10_000_000


def test_equal_stamps_pair_whatever_comes_first():
    """The simulated angle may come before or after the measured one."""
    pairing = Pairing(gap=0.1)
    assert pairing.measured(0, 0, 0.1) == []
    assert pairing.simulated(0, 0, 0.3) == [Pair(0, 0, 0.1, 0.3)]
    assert pairing.simulated(0, _FRAME, 0.4) == []
    (pair,) = pairing.measured(0, _FRAME, 0.1)
    assert pair.difference == pytest.approx(0.3)


def test_a_stamp_between_two_is_interpolated():
    """A camera has its own clock; its frame waits until the simulation has passed it."""
    pairing = Pairing(gap=0.1)
    pairing.simulated(0, 0, 0.0)
    assert pairing.measured(0, _FRAME // 4, 0.5) == []
    (pair,) = pairing.simulated(0, _FRAME, 1.0)
    assert pair.simulated == pytest.approx(0.25)


def test_no_pair_across_a_gap_before_the_start_or_without_an_angle():
    """Nothing is made up where the simulation says nothing or a marker was lost."""
    pairing = Pairing(gap=0.1)
    pairing.measured(0, 0, 0.1)
    assert pairing.simulated(0, _FRAME, 0.0) == []
    assert pairing.measured(0, 15 * _FRAME, 0.1) == []
    assert pairing.simulated(0, 30 * _FRAME, 0.0) == []
    assert pairing.measured(0, 30 * _FRAME, math.nan) == []


def test_a_run_replayed_again_is_not_paired_with_the_first_one():
    """Equal stamps of different epochs do not meet."""
    pairing = Pairing(gap=0.1)
    pairing.simulated(0, 5 * _FRAME, 0.7)
    assert pairing.measured(1, 5 * _FRAME, 0.1) == []
    pairing.simulated(1, 0, 0.2)
    assert pairing.simulated(1, 5 * _FRAME, 0.3) == [Pair(1, 5 * _FRAME, 0.1, 0.3)]


def test_streams_agree_on_the_epoch_whichever_goes_back_first():
    """Each stream sees the replay begin anew at its own moment; a stream that begins later joins the others."""
    epochs = Epochs()
    a, b = StreamEpoch(epochs, late=0.5), StreamEpoch(epochs, late=0.5)
    assert [a.of(0), a.of(200 * _FRAME), b.of(0), b.of(200 * _FRAME)] == [0, 0, 0, 0]
    assert [a.of(0), b.of(199 * _FRAME), b.of(0), a.of(_FRAME)] == [1, 0, 1, 1]
    assert StreamEpoch(epochs, late=0.5).of(0) == 1
