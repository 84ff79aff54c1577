# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Warnings that keep coming."""

from hasel_common.node_process import RepeatedWarnings


def test_nine_hundred_warnings_in_six_minutes_become_a_few():
    """One every ten seconds, and each tells how many were left out."""
    warnings = RepeatedWarnings(10.0)
    said = [warnings.to_say("the supply does not know its voltage", 0.4 * n) for n in range(900)]
    heard = [sentence for sentence in said if sentence]
    assert len(heard) == 36
    assert heard[0] == "the supply does not know its voltage"
    assert heard[1].endswith("(24 more like it in the last 10 s)")


def test_other_numbers_are_the_same_warning_and_other_words_are_not():
    """A gap of another length is no news; another kind of trouble is said at once."""
    warnings = RepeatedWarnings(10.0)
    assert warnings.to_say("no message for 0.12 s", 0.0)
    assert not warnings.to_say("no message for 1.2e-01 s", 1.0)
    assert warnings.to_say("the stamps jumped by -3 s", 1.0)
