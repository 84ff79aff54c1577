"""Which node is to change its lifecycle's state next: up in order, and the driver down when another one ends."""

from collections.abc import Mapping, Sequence
from enum import Enum


class Lifecycle(Enum):
    """Where a node is; ABSENT: nobody answers to its name."""

    ABSENT = "absent"
    UNCONFIGURED = "unconfigured"
    INACTIVE = "inactive"
    ACTIVE = "active"


class Change(Enum):
    """What a node is asked for."""

    CONFIGURE = "configure"
    ACTIVATE = "activate"
    DEACTIVATE = "deactivate"
    CLEANUP = "clean up"


UP = {Lifecycle.UNCONFIGURED: Change.CONFIGURE, Lifecycle.INACTIVE: Change.ACTIVATE}
DOWN = {Lifecycle.ACTIVE: Change.DEACTIVATE, Lifecycle.INACTIVE: Change.CLEANUP}
States = Mapping[str, Lifecycle]


class BringUp:
    """names: in the order in which they go up, and down; the first is the supply's driver.

    Nobody goes up before all are there. When one ends, the first goes down, until all are there again. What somebody
    else has taken down is left to them.
    """

    def __init__(self, names: Sequence[str], up: bool = True) -> None:
        self._names = tuple(names)
        self.up = up
        self._brought: set[str] = set()

    def startup(self) -> None:
        """From now on up, also what somebody took down."""
        self.up = True
        self._brought.clear()

    def shutdown(self) -> None:
        """From now on down."""
        self.up = False

    def next_change(self, states: States) -> tuple[str, Change] | None:
        """Who is to be asked for what, if anybody."""
        if not self.up:
            return self._down(states)
        first, ended = self._names[0], self.ended(states)
        if ended or self.absent(states):
            self._brought -= {first, *ended}
            if states[first] is Lifecycle.ACTIVE:
                return first, Change.DEACTIVATE
        if self.absent(states):
            return None
        for before, change in UP.items():
            for name in self._names:
                if states[name] is before and name not in self._brought:
                    return name, change
        self._brought = set(self._names)
        return None

    def ended(self, states: States) -> list[str]:
        """Who was brought up and is not there any more, or is there anew."""
        return [name for name in self._names if name in self._brought and states[name] not in DOWN]

    def absent(self, states: States) -> list[str]:
        """Who is not there."""
        return [name for name in self._names if states[name] is Lifecycle.ABSENT]

    def _down(self, states: States) -> tuple[str, Change] | None:
        for before, change in DOWN.items():
            for name in self._names:
                if states[name] is before:
                    return name, change
        return None
