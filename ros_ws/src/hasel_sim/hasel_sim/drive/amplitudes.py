"""Names of the amplitudes: the contraction that channels of one kind reach at a level of what they are commanded."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.model.sections import Channel


@dataclass(frozen=True)
class AmplitudeTable:
    """Channels that contract alike at equal levels, and how their amplitudes are called.

    `amplitude_<level>` for a voltage [V], `amplitude_<level>_pa` for a pressure and so on; with the channel's name
    before the level for one that has amplitudes of its own. largest: their upper bound.
    """

    channels: tuple[str, ...]
    unit: str
    largest: float
    own: str = ""

    @property
    def _prefix(self) -> str:
        return f"amplitude_{self.own}_" if self.own else "amplitude_"

    @property
    def _suffix(self) -> str:
        return "" if self.unit == "V" else f"_{self.unit.lower()}"

    def name(self, level: float) -> str:
        """The parameter that holds the contraction at a level."""
        return f"{self._prefix}{level:g}{self._suffix}"

    @property
    def onset(self) -> str:
        """The parameter up to which a drive contracts nothing, in the unit of the levels: `onset`, `onset_pa` ..."""
        own = f"_{self.own}" if self.own else ""
        return f"onset{own}{self._suffix}"

    def level(self, name: str) -> float | None:
        """The level that a parameter's name speaks of; None where it is not one of this table."""
        if not (name.startswith(self._prefix) and name.endswith(self._suffix)):
            return None
        try:
            level = float(name[len(self._prefix) : len(name) - len(self._suffix)])
        except ValueError:
            return None
        return level if level > 0 and name == self.name(level) else None

    def meant_by(self, name: str) -> str | None:
        """How a name that only begins as those of this table should be written; None where it does not."""
        if not name.startswith(self._prefix):
            return None
        try:
            level = float(name[len(self._prefix) :].removesuffix(self._suffix))
        except ValueError:
            level = 0.0
        if level > 0:
            return f"'{self.name(level)}'"
        return f"'{self._prefix}<level>{self._suffix}' with the level in {self.unit}, such as '{self.name(5500)}'"

    def levels(self, names) -> np.ndarray:
        """All levels that these parameter names speak of, ascending."""
        found = [self.level(name) for name in names]
        return np.sort(np.array([level for level in found if level is not None]))


def amplitude_tables(channels: tuple[Channel, ...]) -> tuple[AmplitudeTable, ...]:
    """One table per quantity, and one per channel that has amplitudes of its own."""
    shared: dict[str, list[Channel]] = {}
    tables = []
    for channel in channels:
        if channel.own_amplitudes:
            tables.append(
                AmplitudeTable((channel.name,), channel.unit, channel.largest_contraction, channel.name)
            )
        else:
            shared.setdefault(channel.unit, []).append(channel)
    alike = [
        AmplitudeTable(tuple(c.name for c in group), unit, max(c.largest_contraction for c in group))
        for unit, group in shared.items()
    ]
    return (*alike, *tables)
