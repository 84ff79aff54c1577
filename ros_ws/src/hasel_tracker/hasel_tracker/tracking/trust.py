"""When to believe: what is new is held back until further frames agree with it, and then vouched for."""

from hasel_tracker.tracking.doubt import Doubt

AGREEING_FRAMES = 2
DISAGREEING_FRAMES = 3


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
