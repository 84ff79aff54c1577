# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The virtual output stage: the muscle against circuit theory, contacts and slew limit for any sequence of wishes."""

import itertools
import math

import pytest
from hasel_driver.protocol.limits import DISCHARGED_V
from hasel_driver.virtual.virtual_output import Contact, VirtualBridge, VirtualMuscle
from hypothesis import given
from hypothesis import strategies as st


def run(muscle: VirtualMuscle, duration_s: float, contact: Contact, set_point_v: float = 0.0) -> None:
    """Advance in milliseconds."""
    for _ in range(round(duration_s * 1000)):
        muscle.step(1e-3, contact, set_point_v)


def test_charges_at_the_current_limit():
    """Far from the set point the voltage rises by I/C: 5 W at 10 kV is 0.5 mA."""
    muscle = VirtualMuscle(capacitance_f=2e-9)
    run(muscle, 0.010, Contact.POSITIVE, 10_000.0)
    assert muscle.voltage_v == pytest.approx(500e-6 / 2e-9 * 0.010, rel=0.01)
    assert muscle.current_a == 500e-6


def test_holds_the_set_point_against_leakage():
    """Once charged, the current is what leaks: V/R."""
    muscle = VirtualMuscle()
    run(muscle, 0.2, Contact.NEGATIVE, 6000.0)
    assert muscle.voltage_v == pytest.approx(-6000.0)
    assert muscle.current_a == pytest.approx(6000.0 / 1e9, rel=1e-3)


def test_discharges_slowly_when_left_alone():
    """An open muscle loses its charge with R C, half a second here: 0 V set is not 0 V."""
    muscle = VirtualMuscle(voltage_v=6000.0)
    run(muscle, 0.5, Contact.OPEN)
    assert muscle.voltage_v == pytest.approx(6000.0 / math.e, rel=1e-6)


def test_a_lowered_set_point_does_not_discharge():
    """A converter cannot take charge back: the voltage stays above the new set point."""
    muscle = VirtualMuscle(voltage_v=6000.0)
    run(muscle, 0.05, Contact.POSITIVE, 1000.0)
    assert muscle.voltage_v == pytest.approx(6000.0 * math.exp(-0.1), rel=1e-6)
    assert muscle.current_a == 0.0


def test_grounding_is_quick():
    """Through the 2 MΩ ground resistor 10 kV fall below 50 V in about six milliseconds."""
    muscle = VirtualMuscle(voltage_v=10_000.0)
    run(muscle, 0.006, Contact.GROUND)
    assert abs(muscle.voltage_v) < 50.0


def test_a_short_draws_the_limit():
    """A short keeps the converter at its limit and the voltage at I R."""
    muscle = VirtualMuscle(short_ohm=2e6)
    run(muscle, 0.05, Contact.POSITIVE, 6000.0)
    assert muscle.current_a == 500e-6
    assert muscle.voltage_v == pytest.approx(1000.0, rel=0.01)


DEAD_TIME_MS = 3
WISHES = st.lists(
    st.tuples(st.integers(-6000, 6000), st.integers(1, 40), st.booleans()), min_size=1, max_size=20
)


@given(WISHES, st.integers(1, 2000))
def test_contacts_never_overlap(wishes, slew_v):
    """Between any two closed contacts lies the dead time of open ones, and a source follows only on ground."""
    bridge, muscle, history = VirtualBridge(), VirtualMuscle(), [Contact.GROUND] * 3
    for wanted_v, duration_ms, release in wishes:
        if release:
            bridge.release()
        for _ in range(duration_ms):
            before_v = bridge.set_point_v
            measured_v = muscle.voltage_v
            bridge.step(wanted_v, slew_v, measured_v, DEAD_TIME_MS)
            muscle.step(1e-3, bridge.contact, bridge.set_point_v)
            assert bridge.set_point_v - before_v <= slew_v
            if bridge.contact is not history[-1] and history[-1] is Contact.GROUND:
                assert abs(measured_v) < DISCHARGED_V
            history.append(bridge.contact)
    closed = [(index, contact) for index, contact in enumerate(history) if contact is not Contact.OPEN]
    for (first, a), (second, b) in itertools.pairwise(closed):
        if a is not b:
            assert second - first > DEAD_TIME_MS
            assert Contact.GROUND in (a, b)


@given(st.integers(1, 6000), st.integers(1, 2000))
def test_reaches_what_is_wanted(wanted_v, slew_v):
    """The set point arrives exactly, in the time that the slew limit needs."""
    bridge = VirtualBridge()
    for _ in range(2 * DEAD_TIME_MS + 3 + -(-wanted_v // slew_v)):
        bridge.step(-wanted_v, slew_v, 0.0, DEAD_TIME_MS)
    assert (bridge.contact, bridge.set_point_v) == (Contact.NEGATIVE, wanted_v)
