# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The running error ends where `compare` ends."""

import math

import numpy as np
import pytest
from hasel_sysid.live.running_error import Epochs, Pair, Pairing, RunningErrors, StreamEpoch

_FRAME = 10_000_000


def test_the_offset_of_the_run_is_taken_out():
    """Mean magnitude of the differences less their mean, over the frames so far."""
    generator = np.random.default_rng(1)
    measured, simulated = generator.normal(size=(2, 3000))
    errors = RunningErrors(reset=2.0, window=5.0)
    for n, pair in enumerate(zip(measured, simulated + 5.0, strict=True)):
        error = errors.add(Pair(0, n * _FRAME, *pair))
        if n in (1, 1500, 2999):
            difference = (simulated + 5.0 - measured)[: n + 1]
            expected = np.abs(difference - difference.mean()).mean()
            assert error.mean_absolute == pytest.approx(expected, rel=1e-12)
            assert (error.count, error.difference) == (n + 1, difference[-1])


@pytest.mark.parametrize("second", [Pair(1, 0, 0.0, 3.0), Pair(0, 300 * _FRAME, 0.0, 3.0)])
def test_another_run_begins_anew(second):
    """After a restart or a long gap nothing of the old run is left."""
    errors = RunningErrors(reset=2.0, window=5.0)
    errors.add(Pair(0, 0, 0.0, 1.0))
    assert errors.add(Pair(0, _FRAME, 0.0, 2.0)).count == 2
    error = errors.add(second)
    assert (error.count, error.mean_absolute) == (1, 0.0)


def test_a_better_model_shows_in_the_window_at_once():
    """After ten minutes with a bad model a window's length with a good one tells, where the whole run hardly does."""
    errors = RunningErrors(reset=2.0, window=1.0)
    for n in range(6000):
        error = errors.add(Pair(0, n * _FRAME, 0.0, 0.1 * (-1) ** n))
    assert error.recent == pytest.approx(0.1, rel=0.02)
    for n in range(6000, 6102):
        error = errors.add(Pair(0, n * _FRAME, 0.0, 0.01 * (-1) ** n))
    assert (error.recent, error.window) == (pytest.approx(0.01, rel=0.02), 1.0)
    assert error.mean_absolute > 0.09


def test_driving_after_a_rest_begins_a_new_run():
    """The driver's states go on between two experiments: no gap, no step back, only a rest at 0 V."""
    errors = RunningErrors(reset=2.0, window=5.0)
    counts = []
    for n in range(1000):
        driven = n < 300 or n >= 700
        stamp = n * _FRAME
        errors.state(0, stamp, (5000.0 * driven * (n % 50 < 25), 0.0))
        counts.append(errors.add(Pair(0, stamp, 0.0, 1.0)).count)
    ended = 275 + 100  # the last stroke, and what rings after it
    assert counts[:700] == list(range(1, ended + 2)) + [ended + 1] * (699 - ended)
    assert counts[700:] == list(range(1, 301))


def test_rest_does_not_make_the_error_smaller():
    """The error of a run stays while the body rests after it; the difference is that of each frame."""
    errors = RunningErrors(reset=2.0, window=1.0)
    for n in range(1500):
        swing = 0.1 * (-1) ** n * (n < 200)
        errors.state(0, n * _FRAME, (5000.0 * (n < 200), 0.0))
        error = errors.add(Pair(0, n * _FRAME, 0.0, swing))
        if n == 300:
            at_its_end = error
    assert (error.mean_absolute, error.recent, error.count) == (
        at_its_end.mean_absolute,
        at_its_end.recent,
        301,
    )
    assert error.mean_absolute == pytest.approx(0.1 * 200 / 301, rel=0.01)
    assert error.difference == 0.0


def test_a_body_that_is_never_driven_is_never_at_rest():
    """It swings by itself, until the recording ends."""
    errors = RunningErrors(reset=2.0, window=1.0)
    for n in range(500):
        errors.state(0, n * _FRAME, (0.0, 0.0))
        error = errors.add(Pair(0, n * _FRAME, 0.0, 1.0))
    assert error.count == 500


_PERIOD = 10_000_000


def test_equal_stamps_pair_whatever_comes_first():
    """The simulated angle may come before or after the measured one."""
    pairing = Pairing(gap=0.1)
    assert pairing.measured(0, 0, 0.1) == []
    assert pairing.simulated(0, 0, 0.3) == [Pair(0, 0, 0.1, 0.3)]
    assert pairing.simulated(0, _PERIOD, 0.4) == []
    (pair,) = pairing.measured(0, _PERIOD, 0.1)
    assert pair.difference == pytest.approx(0.3)


def test_a_stamp_between_two_is_interpolated():
    """A camera has its own clock; its frame waits until the simulation has passed it."""
    pairing = Pairing(gap=0.1)
    pairing.simulated(0, 0, 0.0)
    assert pairing.measured(0, _PERIOD // 4, 0.5) == []
    (pair,) = pairing.simulated(0, _PERIOD, 1.0)
    assert pair.simulated == pytest.approx(0.25)


def test_no_pair_across_a_gap_before_the_start_or_without_an_angle():
    """Nothing is made up where the simulation says nothing or a marker was lost."""
    pairing = Pairing(gap=0.1)
    pairing.measured(0, 0, 0.1)
    assert pairing.simulated(0, _PERIOD, 0.0) == []
    assert pairing.measured(0, 15 * _PERIOD, 0.1) == []
    assert pairing.simulated(0, 30 * _PERIOD, 0.0) == []
    assert pairing.measured(0, 30 * _PERIOD, math.nan) == []


def test_a_run_replayed_again_is_not_paired_with_the_first_one():
    """Equal stamps of different epochs do not meet."""
    pairing = Pairing(gap=0.1)
    pairing.simulated(0, 5 * _PERIOD, 0.7)
    assert pairing.measured(1, 5 * _PERIOD, 0.1) == []
    pairing.simulated(1, 0, 0.2)
    assert pairing.simulated(1, 5 * _PERIOD, 0.3) == [Pair(1, 5 * _PERIOD, 0.1, 0.3)]


def test_streams_agree_on_the_epoch_whichever_goes_back_first():
    """Each stream sees the replay begin anew at its own moment; a stream that begins later joins the others."""
    epochs = Epochs()
    a, b = StreamEpoch(epochs, late=0.5), StreamEpoch(epochs, late=0.5)
    assert [a.of(0), a.of(200 * _PERIOD), b.of(0), b.of(200 * _PERIOD)] == [0, 0, 0, 0]
    assert [a.of(0), b.of(199 * _PERIOD), b.of(0), a.of(_PERIOD)] == [1, 0, 1, 1]
    assert StreamEpoch(epochs, late=0.5).of(0) == 1
