"""Real-time scheduling of the threads between a command and the wire, where the system allows it."""

import os


def request_realtime(priority: int) -> str | None:
    """Schedule the calling thread first in, first out, at `priority` (1 to 99; 0 leaves it); why not, or None."""
    if priority == 0:
        return "the parameter realtime_priority is 0"
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except (OSError, AttributeError) as error:
        reason = getattr(error, "strerror", None) or "this system has none"
        return (
            f"{reason}: allow it with the line `@realtime - rtprio {priority}` in /etc/security/limits.conf"
            " and a log-in of a user in the group realtime"
        )
    return None
