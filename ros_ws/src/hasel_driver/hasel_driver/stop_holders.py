"""Who holds the emergency stop: one flag for each publisher of its topic, released by itself or by the service."""

import threading
from collections.abc import Mapping

from hasel_driver.graph_names import UNNAMED


class StopHolders:
    """Publishers are told apart by their identifier in the middleware; names are for people. For any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._holding: dict[bytes, str] = {}
        self._last_sequence: dict[bytes, int] = {}
        self._stops: dict[bytes, set[int]] = {}  # sequence numbers of those that were heard

    def take(self, publisher: bytes, sequence: int, name: str, asserted: bool) -> bool:
        """Note a message; False for one that was heard already, by another of our subscriptions.

        A stop that arrives after its own release holds nothing any more, and still is one.
        """
        with self._lock:
            stops = self._stops.setdefault(publisher, set())
            known = sequence != 0 and sequence in stops
            if asserted:
                stops.add(sequence)
            if sequence and sequence <= self._last_sequence.get(publisher, 0):
                return asserted and not known
            self._last_sequence[publisher] = sequence
            if asserted:
                self._note(publisher, name)
            else:
                self._holding.pop(publisher, None)
        return True

    def release(self) -> list[str]:
        """Take every flag back; the names of those who held one."""
        with self._lock:
            names = sorted(self._holding.values())
            self._holding.clear()
        return names

    def names(self, present: Mapping[bytes, str]) -> list[str]:
        """Who holds the stop; a publisher that is not among those `present` is marked as gone."""
        with self._lock:
            for publisher in self._holding.keys() & present.keys():
                self._note(publisher, present[publisher])
            return sorted(
                name if publisher in present else f"{name} (gone)"
                for publisher, name in self._holding.items()
            )

    def _note(self, publisher: bytes, name: str) -> None:
        """A name may be learnt later, and is kept: a node that ends is nameless before its publisher goes."""
        if name != UNNAMED or publisher not in self._holding:
            self._holding[publisher] = name

    def __bool__(self) -> bool:
        return bool(self._holding)
