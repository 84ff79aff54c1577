"""The announcement of the first compilation."""

import os
import subprocess
import sys

from hasel_sim.first_run import is_compiled
from hasel_sim.simulate import simulate

_ANNOUNCE = "from hasel_sim.first_run import announce_compilation as say; say(); say()"


def test_a_machine_that_has_compiled_nothing_is_told_once(tmp_path):
    """One line on standard error, and how long it will take."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", _ANNOUNCE], env=environment, check=True, capture_output=True, text=True
    )
    assert done.stderr.count("compiling its loops") == 1


def test_nothing_is_said_once_the_loops_are_there(swimmer, boxes):
    """After any simulation."""
    simulate(swimmer, boxes(duration=0.05))
    assert is_compiled()
