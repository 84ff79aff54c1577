"""Corrections that a board keeps for one channel's converter and voltage monitor (`firmware/PROTOCOL.md`)."""

from dataclasses import astuple, dataclass

UNITY = 10_000
CALIBRATION_RANGES: dict[str, tuple[int, int]] = {
    "set_gain": (9_000, 11_000),
    "set_offset_v": (-300, 300),
    "read_gain": (9_000, 11_000),
    "read_offset_v": (-150, 150),
}


@dataclass(frozen=True)
class Calibration:
    """Gains in 1/10000, offsets in V; as it stands, no correction."""

    set_gain: int = UNITY
    set_offset_v: int = 0
    read_gain: int = UNITY
    read_offset_v: int = 0

    def set_point_v(self, volts: float) -> float:
        """What to ask of the converter [V] for `volts` on the muscle."""
        return max(0.0, volts * self.set_gain / UNITY + self.set_offset_v) if volts else 0.0

    def measured_v(self, volts: float) -> float:
        """Voltage of the muscle [V] when its monitor says `volts`."""
        return max(0.0, volts * self.read_gain / UNITY + self.read_offset_v)

    def words(self) -> str:
        """As in a command or reply."""
        return " ".join(map(str, astuple(self)))
