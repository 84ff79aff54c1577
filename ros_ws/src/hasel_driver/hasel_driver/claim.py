"""Who may command: one publisher of commands at a time holds the claim that arming hands out."""

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from hasel_driver.graph_names import UNNAMED

SILENT_S = 0.2  # after which a holder that was started anew has its claim again


@dataclass
class _Holder:
    publisher: bytes
    name: str
    heard_s: float


class Claim:
    """Publishers are told apart by their identifier in the middleware, a node that comes back by its name.

    For any thread.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock, self._lock = clock, threading.Lock()
        self._holder: _Holder | None = None

    @property
    def holder(self) -> str:
        """Its node's name; empty where nobody has it."""
        holder = self._holder
        return holder.name if holder else ""

    def hand_out(self, publishers: Mapping[bytes, str]) -> None:
        """At arming: to the only publisher there is; where there is none, to the first that is heard."""
        with self._lock:
            self._holder = None
            if len(publishers) == 1:
                ((publisher, name),) = publishers.items()
                self._holder = _Holder(publisher, name, self._clock())

    def take(self, publisher: bytes, name: str) -> tuple[bool, bool]:
        """Whether a command of `publisher` is to be obeyed, and whether that is one that was not obeyed before."""
        with self._lock:
            now_s, holder = self._clock(), self._holder
            if holder is not None and holder.publisher == publisher:
                holder.heard_s, holder.name = now_s, name  # which the graph may have told only now
                return True, False
            named = holder is not None and holder.name == name != UNNAMED
            back = named and now_s - holder.heard_s > SILENT_S
            if holder is None or back:
                self._holder = _Holder(publisher, name, now_s)
                return True, True
            return False, False
