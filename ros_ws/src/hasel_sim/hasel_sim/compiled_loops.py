# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Compiled loops that an earlier run left on this machine; `hasel_sim.first_run` compiles them.

Old ones are taken away, and compiling anew is announced. Numba keeps each function with a stamp of its own file. A
function that calls one of another file would go on doing what that file said when it was compiled, so the loops of one
version are kept together or not at all.
"""

import multiprocessing
import sys
from contextlib import suppress
from functools import cache
from hashlib import sha256
from pathlib import Path

from hasel_sim.dynamics.time_loop import integrate
from hasel_sim.laws.program import operate
from hasel_sim.mechanics.balance import balance

_LOOPS = integrate, operate, balance
"""One of every folder that has any."""


def is_compiled() -> bool:
    """Whether an earlier run left its compiled loops on this machine."""
    return any(_folders()[0].glob("time_loop.integrate-*.nbc"))


def forget_other_versions() -> None:
    """Delete the compiled loops of other sources than these."""
    folders = [Path(loop.py_func.__code__.co_filename).parent for loop in _LOOPS]
    sources = sorted(path for folder in folders for path in folder.glob("*.py"))
    version = sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()
    stamp = _folders()[0] / "version_of_the_loops"
    if stamp.is_file() and stamp.read_text() == version:
        return
    with suppress(OSError):  # a folder that is read only holds what was installed with it
        for path in [path for folder in _folders() for path in folder.glob("*.nb[ci]")]:
            path.unlink(missing_ok=True)
        stamp.parent.mkdir(parents=True, exist_ok=True)
        stamp.write_text(version)


@cache
def announce_compilation() -> None:
    """Before a process first simulates: one line, in the main process, if the loops are about to be compiled."""
    forget_other_versions()
    if multiprocessing.parent_process() is None and not is_compiled():
        print(
            "hasel_sim: first run on this machine, compiling its loops (some 15 to 60 s, once) …",
            file=sys.stderr,
            flush=True,
        )


def _folders() -> list[Path]:
    return [Path(loop.stats.cache_path) for loop in _LOOPS]
