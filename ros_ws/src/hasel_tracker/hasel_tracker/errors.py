# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The tracker's own exception (what was found, what was expected and what to do), and how a command ends with it."""

from collections.abc import Callable

from hasel_common.command_entry import in_a_sentence


class TrackerError(Exception):
    """Bad input or an unusable device; the text is meant to be shown to the user as it is."""


def run_command(work: Callable[[], None]) -> int:
    """Run a command; returns its exit code: 0, 1 after an error (told on stderr), 130 after Ctrl-C."""
    return in_a_sentence(work, (TrackerError,), code=1)
