"""Alignment of the board's clock with the host's."""

import random

import pytest
from hasel_driver.device_clock import DeviceClock


def test_random_delays_are_removed():
    """With delays of up to 20 ms the stamps are right to a millisecond, once a quick line has been seen."""
    clock, generator = DeviceClock(), random.Random(1)
    errors = []
    for index in range(1000):
        device_s = index * 0.01
        arrival_s = 500.0 + device_s + 0.0005 + generator.expovariate(1 / 0.005)
        errors.append(clock.host_time(int(device_s * 1e6), arrival_s) - (500.0 + device_s))
    assert max(map(abs, errors[200:])) < 0.001


def test_follows_a_drifting_resonator():
    """A board 0.5 % fast for ten minutes is followed to better than 100 ms."""
    clock = DeviceClock()
    for index in range(60_000):
        arrival_s = index * 0.01
        stamp_s = clock.host_time(int(arrival_s * 1.005e6), arrival_s)
    assert stamp_s == pytest.approx(arrival_s, abs=0.1)


def test_the_counter_may_overflow():
    """After 71 minutes the board's counter starts again; time goes on."""
    clock = DeviceClock()
    before = clock.host_time(2**32 - 5000, 100.0)
    assert clock.host_time(5000, 100.01) == pytest.approx(before + 0.01)


def test_stamps_increase_and_never_lie_in_the_future():
    """Whatever the delays, stamps keep their order and none is later than its arrival."""
    clock, generator, last = DeviceClock(), random.Random(2), -1.0
    arrival_s = 0.0
    for index in range(500):
        arrival_s = max(arrival_s + 1e-4, index * 0.01 + generator.choice([0.0, 0.001, 0.3]))
        stamp_s = clock.host_time(index * 10_000, arrival_s)
        assert last < stamp_s <= arrival_s
        last = stamp_s
