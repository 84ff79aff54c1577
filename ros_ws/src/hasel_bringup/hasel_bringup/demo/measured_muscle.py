"""Recordings of a real muscle on its bench that the demo treats when it is given their folder."""

from pathlib import Path

from hasel_bringup.errors import BringupError

STEPS = "*step*.mat"
PLACES = (".", "raw_data", "post_process/raw_data")
UNSEEN_VOLTAGES = (1000, 2500, 4000, 5500, 7000)
"""Every third of the voltages, 0.5 to 8 kV, that the public recording lifts at."""


def steps_in(folder: Path) -> list[Path]:
    """Recordings of steps in a clone of the public repository, or in its folder of raw data.

    Raises BringupError for a folder that holds none.
    """
    found = [path for place in PLACES for path in sorted((folder / place).glob(STEPS))]
    if not found:
        raise BringupError(
            f"there is no {STEPS} in {folder}, nor in its {PLACES[-1]}; expected a clone of the public repository "
            "MadhavL/PH-HASEL-Python: name its folder"
        )
    return found
