"""A process that ends with the one that started it."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

CHILD = """
import signal, time
from hasel_common.parent import {function}
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
