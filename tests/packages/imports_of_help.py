# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Prints as JSON what each executable of ours says to an option and which of the modules named are imported by then.

Called with the option, --help or --version, and the modules.

Each runs in a process forked from this one, in which nothing but the standard library is imported.
"""

import contextlib
import io
import json
import os
import sys
from importlib.metadata import EntryPoint, distributions


def asked(entry: EntryPoint, option: str, watched: list[str]) -> dict:
    """Call an executable's function with the option, in this process."""
    sys.argv = [entry.name, option]
    code, said = None, io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            code = entry.load()()
        except SystemExit as leaving:
            code = leaving.code
    return {"code": code or 0, "said": said.getvalue(), "imported": [m for m in watched if m in sys.modules]}


def in_a_fork(entry: EntryPoint, option: str, watched: list[str]) -> dict:
    """The same in a process of its own."""
    reading, writing = os.pipe()
    if os.fork() == 0:
        with os.fdopen(writing, "w", encoding="utf-8") as pipe:
            json.dump(asked(entry, option, watched), pipe)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, encoding="utf-8") as pipe:
        answer = json.load(pipe)
    os.wait()
    return answer


if __name__ == "__main__":
    entries = {
        f"{distribution.name} {entry.name}": entry
        for distribution in distributions()
        if distribution.name.startswith("hasel_")
        for entry in distribution.entry_points.select(group="console_scripts")
    }
    option, *watched = sys.argv[1:]
    print(json.dumps({name: in_a_fork(entry, option, watched) for name, entry in entries.items()}))
