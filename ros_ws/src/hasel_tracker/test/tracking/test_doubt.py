# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""When frames in doubt come to count."""

from hasel_tracker.tracking.doubt import Doubt, Trust


def test_two_agreeing_frames_vouch_for_those_before():
    """A start counts with the second frame that agrees, which then vouches for the two before it."""
    trust = Trust()
    assert trust.shake(Doubt.STARTING) is Doubt.STARTING
    assert trust.agree() == (Doubt.STARTING, 0)
    assert trust.agree() == (Doubt.NONE, 2)
    assert trust.agree() == (Doubt.NONE, 0)


def test_what_was_ambiguous_is_never_vouched_for():
    """Frames in which something else fitted stay without an angle, also once the doubt has gone."""
    trust = Trust()
    trust.shake(Doubt.AMBIGUOUS, recoverable=False)
    trust.agree()
    assert trust.agree() == (Doubt.NONE, 1)


def test_an_interruption_leaves_what_was_held_behind():
    """A marker that goes away again: the frames before are not vouched for, and the count starts anew."""
    trust = Trust()
    trust.shake(Doubt.JUMP)
    trust.interrupt()
    trust.shake(Doubt.FOUND_AGAIN)
    trust.agree()
    assert trust.agree() == (Doubt.NONE, 2)


def test_three_frames_that_disagree_break_it():
    """After three frames in a row without a body what is followed is given up."""
    trust = Trust()
    for _ in range(2):
        assert trust.disagree() is Doubt.AMBIGUOUS
    assert not trust.broken
    trust.disagree()
    assert trust.broken
