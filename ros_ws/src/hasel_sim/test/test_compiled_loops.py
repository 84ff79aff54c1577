# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The announcement of the first compilation."""

import os
import subprocess
import sys

from hasel_sim.compiled_loops import is_compiled
from hasel_sim.simulate import simulate

_ANNOUNCE = "from hasel_sim.compiled_loops import announce_compilation as say; say(); say()"


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


def test_loops_of_another_version_are_not_used(tmp_path):
    """They are deleted before anything is simulated; those of this version stay, and nothing else is touched."""
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    command = [sys.executable, "-c", _ANNOUNCE]
    subprocess.run(command, env=environment, check=True, capture_output=True)
    (stamp,) = tmp_path.rglob("version_of_the_loops")
    loops = [
        stamp.parent / name
        for name in ("time_loop.integrate-1.py311.nbi", "time_loop.integrate-1.py311.1.nbc")
    ]
    kept = stamp.parent / "another.file"
    for path in [*loops, kept]:
        path.write_text("")
    subprocess.run(command, env=environment, check=True, capture_output=True)
    assert all(path.exists() for path in loops)
    stamp.write_text("of another version")
    said = subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stderr
    assert not any(path.exists() for path in loops)
    assert kept.exists()
    assert said.count("compiling its loops") == 1
