"""What was seen of a test pulse, so that one that proves nothing says where it saw no load."""

from hasel_driver.limits import DISCHARGED_V, MUSCLE_NAMES
from hasel_driver.mode import Mode
from hasel_driver.protocol import Telemetry

LEAST_CHARGING_UA = 2  # two steps of the monitor: 0.5 nF draw 5 µA at the pulse's 10 V/ms


class PulseSight:
    """Takes the reports from the begin of the pulse on; the highest magnitudes of each channel count."""

    def __init__(self) -> None:
        self._most: list[tuple[int, int]] | None = None  # V and µA, of each channel

    def take(self, report: Telemetry) -> None:
        """One report; those that are not of the pulse are left out."""
        if report.mode is Mode.ACTIVE:
            before = self._most or [(0, 0)] * len(MUSCLE_NAMES)
            now = zip(map(abs, report.measured), report.current, strict=True)
            self._most = [(max(v, w), max(i, j)) for (v, i), (w, j) in zip(before, now, strict=True)]

    def without_load(self, measured_v: tuple[int, int]) -> str:
        """Where no load was seen, in words; nothing for a channel on which there is voltage `measured_v` still."""
        if self._most is None:
            return ""
        found = [
            f"{name} at most {most_v} V and {most_ua} µA"
            for name, still_v, (most_v, most_ua) in zip(MUSCLE_NAMES, measured_v, self._most, strict=True)
            if most_ua < LEAST_CHARGING_UA and abs(still_v) < DISCHARGED_V
        ]
        where = ", ".join(found)
        return where and f"the test pulse saw no load ({where}): look for a muscle that is not connected"
