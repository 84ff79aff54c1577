"""A sentence that keeps coming is said once in a while, with how often it came."""

import re
from dataclasses import dataclass

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
