"""Break before make and slew limit of the virtual output stage, for any sequence of wishes."""

import itertools

from hasel_driver.limits import DISCHARGED_V
from hasel_driver.virtual_bridge import VirtualBridge
from hasel_driver.virtual_muscle import Contact, VirtualMuscle
from hypothesis import given
from hypothesis import strategies as st

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
