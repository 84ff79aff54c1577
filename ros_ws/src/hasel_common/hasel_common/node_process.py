# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What nodes share: start, one sentence for what is wrong with their parameters, warnings that repeat, a quiet end."""

import os
import re
import signal
import sys
from collections.abc import Callable
from dataclasses import dataclass

import rclpy
from rclpy.exceptions import InvalidParameterValueException
from rclpy.node import Node

from hasel_common.command_entry import end_with_parent
from hasel_common.managed_node import quiet_at_shutdown


def run_node(
    make: Callable[[], Node],
    spin: Callable[[Node], None] = rclpy.spin,
    errors: tuple[type[Exception], ...] = (),
) -> int:
    """Make a node and spin it until it is interrupted or its parent ends; returns the exit code.

    errors: told in one sentence, as a parameter out of range is.
    """
    end_with_parent()
    rclpy.init()
    node = None
    try:
        with quiet_at_shutdown():  # which may come while it is being made, too
            node = make()
            spin(node)
    except (*errors, InvalidParameterValueException) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        pass
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in a launch file comes twice
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


def end_at_once(code: int) -> None:
    """End the process without waiting for a thread that is in the middle of something long.

    Worker processes notice and end too.
    """
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


PERIOD_S = 10.0
"""Between two warnings that differ by their numbers alone."""


@dataclass
class _Said:
    at: float
    unsaid: int = 0


class RepeatedWarnings:
    """Lets the first of like sentences through and then one every `period` [s]; like ones differ by numbers alone."""

    def __init__(self, period: float = PERIOD_S) -> None:
        self._period = period
        self._said: dict[str, _Said] = {}

    def to_say(self, sentence: str, now: float) -> str:
        """What to say of a sentence that came at `now` [s]: itself, with how often it came unsaid, or nothing."""
        kind = re.sub(r"[-+\d.]+(e[-+]?\d+)?", "#", sentence)
        said = self._said.get(kind)
        if said is not None and now - said.at < self._period:
            said.unsaid += 1
            return ""
        self._said[kind] = _Said(now)
        if said is None or said.unsaid == 0:
            return sentence
        return f"{sentence} ({said.unsaid} more like it in the last {now - said.at:.0f} s)"
