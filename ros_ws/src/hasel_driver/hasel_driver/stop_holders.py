"""Who holds the emergency stop: one flag for each publisher of its topic, released by itself or by the service."""

from collections.abc import Mapping


class StopHolders:
    """Publishers are told apart by their identifier in the middleware; names are for people."""

    def __init__(self) -> None:
        self._holding: dict[bytes, str] = {}
        self._last_sequence: dict[bytes, int] = {}

    def take(self, publisher: bytes, sequence: int, name: str, asserted: bool) -> bool:
        """Note a message; False for one that was heard already, by another of our subscriptions."""
        if sequence and sequence <= self._last_sequence.get(publisher, 0):
            return False
        self._last_sequence[publisher] = sequence
        if asserted:
            self._holding[publisher] = name
        else:
            self._holding.pop(publisher, None)
        return True

    def release(self) -> list[str]:
        """Take every flag back; the names of those who held one."""
        names = list(self._holding.values())
        self._holding.clear()
        return names

    def names(self, present: Mapping[bytes, str]) -> list[str]:
        """Who holds the stop; a publisher that is not among those `present` is marked as gone."""
        return sorted(
            present.get(publisher, f"{name} (gone)") for publisher, name in list(self._holding.items())
        )

    def __bool__(self) -> bool:
        return bool(self._holding)
