"""Says so when the compiled loops are not there yet, so that nobody waits without knowing why."""

import multiprocessing
import sys
from functools import cache
from pathlib import Path

from hasel_sim.mechanics import compiled


def is_compiled() -> bool:
    """Whether an earlier run left its compiled loops on this machine."""
    folder = Path(compiled.first_piola.stats.cache_path)
    return any(folder.glob("compiled.first_piola-*.nbc"))


@cache
def announce_compilation() -> None:
    """Print one line, once, in the main process, if the loops are about to be compiled."""
    if multiprocessing.parent_process() is None and not is_compiled():
        print(
            "hasel_sim: first run on this machine, compiling its loops (some 10 to 30 s, once) …",
            file=sys.stderr,
            flush=True,
        )
