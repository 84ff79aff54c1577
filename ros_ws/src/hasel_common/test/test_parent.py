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
from hasel_common.parent import end_with_parent
end_with_parent(though_nohup={though})
print("ready", flush=True)
time.sleep(60)
"""
PARENT = """
import signal, subprocess, sys, time
if {nohup}: signal.signal(signal.SIGHUP, signal.SIG_IGN)
child = subprocess.Popen([sys.executable, "-c", sys.argv[1]], stdout=subprocess.PIPE, text=True)
child.stdout.readline()
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


@pytest.mark.parametrize(
    ("nohup", "though", "ends"), [(False, False, True), (True, False, False), (True, True, True)]
)
def test_it_ends_however_its_parent_ends(nohup, though, ends):
    """Also where that is killed; with nohup it stays, unless nothing may."""
    parent = subprocess.Popen(
        [sys.executable, "-c", PARENT.format(nohup=nohup), CHILD.format(though=though)],
        stdout=subprocess.PIPE,
        text=True,
    )
    child = int(parent.stdout.readline())
    parent.kill()
    parent.wait()
    deadline_s = time.monotonic() + (10.0 if ends else 1.0)
    while is_alive(child) and time.monotonic() < deadline_s:
        time.sleep(0.02)
    assert is_alive(child) != ends
    if not ends:
        os.kill(child, signal.SIGKILL)
