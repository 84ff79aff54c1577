# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Every command begins by one function, no stack trace leaves it, and it ends with the process that started it."""

import errno
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hasel_common.command_entry import command, of_system

COUNTS = """
import sys
from pathlib import Path
from hasel_common.command_entry import command
@command
def main():
    print(f"\\u03b8 of {len(Path('run.csv').read_text().splitlines())} frames, home {Path.home().is_dir()}")
sys.exit(main())
"""
PROGRAM = [sys.executable, "-c", COUNTS]


def run(folder: Path, *arguments: str, program: list[str] = PROGRAM, **environment: str):
    """A command in a folder of its own, with some of its environment changed; '' removes a variable."""
    (folder / "run.csv").write_text("0.1\n0.2\n0.1\n")
    surroundings = {**os.environ, **environment}
    surroundings = {key: value for key, value in surroundings.items() if value}
    return subprocess.run(
        [*program, *arguments], cwd=folder, env=surroundings, capture_output=True, timeout=60, check=False
    )


@pytest.mark.parametrize(
    "environment",
    [
        {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
        {"PYTHONIOENCODING": "ascii"},
        {"PYTHONIOENCODING": "latin-1"},
        {"HOME": ""},
        {"HOME": "/nonexistent"},
        {"MPLBACKEND": "module://matplotlib_inline.backend_inline"},
    ],
    ids=["C", "ascii", "latin-1", "unset home", "no home", "notebook"],
)
def test_surroundings_change_nothing(tmp_path, environment):
    """Another locale, no home or a notebook's settings: the command does its work, at worst with a '?'."""
    done = run(tmp_path, **environment)
    assert done.returncode == 0, done.stderr
    assert b"3 frames, home True" in done.stdout
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.csv"]


def test_a_file_of_the_lab_beside_the_data_is_left_alone(tmp_path):
    """A signal.py in the working folder is not imported, also not by the workers' server."""
    (tmp_path / "signal.py").write_text("raise SystemExit('the wrong signal')\n")
    program = (
        "import sys, os\nimport multiprocessing as m\n"
        "from hasel_common.command_entry import command\n"
        "@command\ndef main():\n"
        "    with m.get_context('forkserver').Pool(1) as pool:\n        print(pool.apply(os.getcwd))\n"
        "if __name__ == '__main__':\n    sys.exit(main())\n"
    )
    (tmp_path / "tool").mkdir()
    (tmp_path / "tool" / "program.py").write_text(program)
    done = run(tmp_path, program=[sys.executable, str(tmp_path / "tool" / "program.py")])
    assert done.returncode == 0, done.stderr
    assert b"wrong signal" not in done.stderr


def test_what_nobody_foresaw_is_a_file_to_send(tmp_path, monkeypatch, capsys):
    """The stack trace goes into a file, its place and the error into one sentence."""
    monkeypatch.chdir(tmp_path)

    @command
    def main():
        raise KeyError("hue")

    assert main() == 70
    (written,) = tmp_path.glob("hasel_error_*.txt")
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "KeyError: 'hue'" in said and str(written) in said
    assert "Traceback" in written.read_text()


@pytest.mark.parametrize(
    ("error", "code", "said"),
    [
        (KeyboardInterrupt(), 130, "stopped"),
        (MemoryError(), 2, "the memory is not enough"),
        (
            OSError(errno.ENOSPC, "No space left on device", "/data/x.csv"),
            2,
            "/data/x.csv: No space left .* free some",
        ),
        (
            OSError(errno.EROFS, "Read-only file system", "/data"),
            2,
            "/data: Read-only .* choose another place",
        ),
    ],
)
def test_every_error_is_a_sentence(error, code, said, capsys):
    """Ctrl-C, no memory, a full or read-only disk: what failed and what to do."""

    @command
    def main():
        raise error

    assert main() == code
    assert re.search(said, capsys.readouterr().err)


def test_no_shared_memory_is_said_as_such():
    """Where processes cannot work together, no output folder is blamed."""
    try:
        exec(
            compile("raise OSError(38, 'Function not implemented')", "multiprocessing/synchronize.py", "exec")
        )
    except OSError as error:
        assert of_system(error) == (
            "processes cannot work together here (Function not implemented): try again with --jobs 1"
        )


CHILD = """
import signal, time
from hasel_common.command_entry import {function}
{function}()
print("ready", flush=True)
time.sleep(60)
"""
PARENT = """
import signal, subprocess, sys, threading, time
if {nohup}: signal.signal(signal.SIGHUP, signal.SIG_IGN)
def start():
    global child
    child = subprocess.Popen([sys.executable, "-c", sys.argv[1]], stdout=subprocess.PIPE, text=True)
    child.stdout.readline()
if {thread}:
    thread = threading.Thread(target=start)
    thread.start()
    thread.join()
else:
    start()
print(child.pid, flush=True)
time.sleep(60)
"""


def is_alive(process_id: int) -> bool:
    """Whether it runs; one that has ended and that nobody waits for does not."""
    status = Path(f"/proc/{process_id}/stat")
    try:
        return status.read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def started(function: str, nohup: bool = False, thread: bool = False) -> tuple[subprocess.Popen, int]:
    """A parent, and the process that it has started, from a thread that has ended or from its main one."""
    parent = subprocess.Popen(
        [sys.executable, "-c", PARENT.format(nohup=nohup, thread=thread), CHILD.format(function=function)],
        stdout=subprocess.PIPE,
        text=True,
    )
    return parent, int(parent.stdout.readline())


def ends(process_id: int, within_s: float) -> bool:
    """Whether it ends in time."""
    deadline_s = time.monotonic() + within_s
    while is_alive(process_id) and time.monotonic() < deadline_s:
        time.sleep(0.02)
    return not is_alive(process_id)


@pytest.mark.parametrize(
    ("function", "nohup", "expected"),
    [
        ("end_with_parent", False, True),
        ("end_with_parent", True, False),
        ("end_at_once_with_parent", True, True),
    ],
)
def test_it_ends_however_its_parent_ends(function, nohup, expected):
    """Also where that is killed; with nohup it stays, unless it may be armed."""
    parent, child = started(function, nohup)
    parent.kill()
    parent.wait()
    assert ends(child, 10.0 if expected else 1.5) == expected
    if not expected:
        os.kill(child, signal.SIGKILL)


def test_it_goes_on_where_only_a_thread_of_its_parent_ends():
    """As the simulator does that the workbench starts."""
    parent, child = started("end_with_parent", thread=True)
    assert not ends(child, 1.5)
    parent.kill()
    parent.wait()
    assert ends(child, 10.0)
