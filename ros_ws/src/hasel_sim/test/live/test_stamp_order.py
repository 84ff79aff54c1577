# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Messages late, twice, missing, or of a new run."""

import pytest
from hasel_sim.live.live_simulator import Arrival, StampOrder

_FRAME = 8_333_333


@pytest.mark.parametrize(
    ("step", "arrival"),
    [
        (_FRAME, Arrival.NEXT),
        (0, Arrival.HELD),
        (-_FRAME, Arrival.HELD),
        (500_000_000, Arrival.GAP),
        (3_000_000_000, Arrival.RESTART),
        (-400_000_000, Arrival.HELD),
        (-600_000_000, Arrival.RESTART),
    ],
)
def test_a_step_in_the_stamps_is_judged_by_its_length(step, arrival):
    """Next, twice, late, gap and new run are told apart, and all but the ordinary one is said."""
    order = StampOrder(gap=0.1, reset=2.0, late=0.5)
    order.judge(10_000_000_000)
    verdict = order.judge(10_000_000_000 + step)
    assert verdict.arrival == arrival
    assert bool(verdict.sentence) == (arrival != Arrival.NEXT)


def test_a_held_message_does_not_become_the_newest():
    """After one late message the next in order is an ordinary one."""
    order = StampOrder(gap=0.1, reset=2.0, late=0.5)
    order.judge(10 * _FRAME)
    order.judge(5 * _FRAME)
    assert order.judge(6 * _FRAME).arrival == Arrival.HELD
    assert order.judge(11 * _FRAME).arrival == Arrival.NEXT


def test_a_forgotten_order_begins_anew():
    """The first message after `forget` starts a run whatever its stamp."""
    order = StampOrder(gap=0.1, reset=2.0, late=0.5)
    order.judge(10 * _FRAME)
    order.forget()
    assert order.judge(5 * _FRAME).arrival == Arrival.START
