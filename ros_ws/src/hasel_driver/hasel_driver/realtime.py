"""Real-time scheduling of the threads between a command and the wire, where the system allows it."""

import os
from pathlib import Path

MIDDLEWARE_PREFIX = "dds."  # of the names of Fast DDS's threads


def request_realtime(priority: int, thread: int = 0) -> str | None:
    """Schedule a thread (0: the calling one) first in, first out, at `priority` (1 to 99); why not, or None.

    Priority 0 leaves it as it is.
    """
    if priority == 0:
        return "the parameter realtime_priority is 0"
    try:
        os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(priority))
    except (OSError, AttributeError) as error:
        reason = getattr(error, "strerror", None) or "this system has none"
        return (
            f"{reason}: allow it with the line `@realtime - rtprio {priority}` in /etc/security/limits.conf"
            " and a log-in of a user in the group realtime"
        )
    return None


def middleware_threads() -> list[int]:
    """The threads of this process in which Fast DDS receives what others publish; none where that is not known."""
    names = {int(task.parent.name): task.read_text() for task in Path("/proc/self/task").glob("*/comm")}
    return [thread for thread, name in names.items() if name.startswith(MIDDLEWARE_PREFIX)]
