# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Why an angle is withheld although every marker was seen, and when it counts: once further frames agree."""

from enum import IntEnum

AGREEING_FRAMES = 2
DISAGREEING_FRAMES = 3


class Doubt(IntEnum):
    """NONE, or the reason."""

    NONE = 0
    STARTING = 1
    AMBIGUOUS = 2
    JUMP = 3
    FOUND_AGAIN = 4

    def __str__(self) -> str:
        return _SENTENCES[self]


_SENTENCES = {
    Doubt.NONE: "no doubt",
    Doubt.STARTING: "the markers were only just found",
    Doubt.AMBIGUOUS: "other marks fit as well",
    Doubt.JUMP: "a marker jumped",
    Doubt.FOUND_AGAIN: "a marker was away and is back only just",
}


class Trust:
    """Counts frames since something happened that puts the markers in doubt."""

    def __init__(self) -> None:
        self.pending = Doubt.NONE
        self._agreed = 0
        self._disagreed = 0
        self._held = 0

    @property
    def broken(self) -> bool:
        """Whether so many frames disagreed that what is followed is not the swimmer."""
        return self._disagreed >= DISAGREEING_FRAMES

    def shake(self, doubt: Doubt, recoverable: bool = True) -> Doubt:
        """Note an event in this frame. recoverable: later frames may show that this one was right."""
        self.pending, self._agreed = doubt, 0
        self._held = self._held + 1 if recoverable else 0
        return doubt

    def interrupt(self) -> None:
        """A marker is not in view: what was held back stays so."""
        self._agreed = self._held = 0
        self.pending = Doubt.FOUND_AGAIN if self.pending is not Doubt.STARTING else Doubt.STARTING

    def agree(self) -> tuple[Doubt, int]:
        """A frame agrees: the doubt that remains, and how many frames before it are now vouched for."""
        self._disagreed = 0
        if self.pending is Doubt.NONE:
            return Doubt.NONE, 0
        self._agreed += 1
        if self._agreed < AGREEING_FRAMES:
            self._held += 1
            return self.pending, 0
        held, self._held, self.pending = self._held, 0, Doubt.NONE
        return Doubt.NONE, held

    def disagree(self) -> Doubt:
        """A frame disagrees: nothing held back is vouched for."""
        self._disagreed += 1
        self._agreed = self._held = 0
        self.pending = self.pending or Doubt.AMBIGUOUS
        return self.pending
