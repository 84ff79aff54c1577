"""Ends this process with the one that started it: `ros2 launch` ended by SIGTERM leaves its nodes running."""

import ctypes
import os
import signal
import sys

_PR_SET_PDEATHSIG = 1


def end_with_parent() -> None:
    """From here on SIGTERM comes when the parent ends, however; on Linux only."""
    if not sys.platform.startswith("linux"):
        return
    parent = os.getppid()
    ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:  # it has ended just now
        os.kill(os.getpid(), signal.SIGTERM)
