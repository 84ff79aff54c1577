"""Ends this process with the one that started it: `ros2 launch` ended by SIGTERM leaves its nodes running."""

import ctypes
import os
import signal
import sys
import threading
import time

_PERIOD_S = 0.5
_PR_SET_PDEATHSIG = 1


def end_with_parent() -> None:
    """From here on SIGTERM comes soon after the parent has ended, however; not to what was started with `nohup`."""
    if signal.getsignal(signal.SIGHUP) == signal.SIG_IGN:
        return
    parent = os.getppid()

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(_PERIOD_S)
        os.kill(os.getpid(), signal.SIGTERM)

    threading.Thread(target=watch, name="parent", daemon=True).start()


def end_at_once_with_parent() -> None:
    """The same at once, `nohup` or not, for what may be armed; also where only the parent's thread ends. Linux only."""
    if not sys.platform.startswith("linux"):
        return
    parent = os.getppid()
    ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:  # it has ended just now
        os.kill(os.getpid(), signal.SIGTERM)
