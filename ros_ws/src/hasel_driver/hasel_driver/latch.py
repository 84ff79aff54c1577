"""What outlives a board's reset: a fault that only its proof, or the interlock seen open, takes away."""

from enum import Enum, auto


class Latch(Enum):
    """In the board's EEPROM."""

    UNPROVEN = auto()
    DISAGREED = auto()
