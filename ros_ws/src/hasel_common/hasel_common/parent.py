"""Ends this process with the one that started it: `ros2 launch` ended by SIGTERM leaves its nodes running."""

import ctypes
import os
import signal
import sys

_PR_SET_PDEATHSIG = 1


def end_with_parent(though_nohup: bool = False) -> None:
    """From here on SIGTERM comes when the parent ends, however; on Linux only.

    though_nohup: also for a process that was started to outlive its parent (`nohup`), as nothing armed may.
    """
    meant_to_stay = signal.getsignal(signal.SIGHUP) == signal.SIG_IGN and not though_nohup
    if not sys.platform.startswith("linux") or meant_to_stay:
        return
    parent = os.getppid()
    ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:  # it has ended just now
        os.kill(os.getpid(), signal.SIGTERM)
