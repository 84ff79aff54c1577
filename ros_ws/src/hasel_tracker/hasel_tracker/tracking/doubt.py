"""Why an angle is withheld although every marker was seen; numbered as in hasel_interfaces/BendingAngle."""

from enum import IntEnum


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
