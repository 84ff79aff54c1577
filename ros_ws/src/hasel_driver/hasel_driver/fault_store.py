"""Keeps on disk, for each port, the fault that a restarted node must still have."""

import json
from dataclasses import asdict
from pathlib import Path

from hasel_driver.errors import PortError
from hasel_driver.faults import OUTLIVE_RESTART, Fault, FaultCode

FILE = "latched_faults.json"


class FaultStore:
    """One file in `folder`, an entry for each port; an empty folder keeps nothing."""

    def __init__(self, folder: str, port: str) -> None:
        self._path = Path(folder).expanduser() / FILE if folder else None
        self._port = port
        self._kept: Fault | None = None

    def load(self) -> Fault | None:
        """The fault that was kept. Raises PortError where the file makes no sense: nobody knows then."""
        entry = self._entries().get(self._port)
        try:
            self._kept = Fault(**{**entry, "code": FaultCode(entry["code"])}) if entry else None
        except (KeyError, TypeError, ValueError) as error:
            raise self._unreadable() from error
        return self._kept

    def keep(self, fault: Fault | None) -> None:
        """From now on this fault, or none; written where that is a change. Raises OSError."""
        outlives = fault if fault is not None and fault.code in OUTLIVE_RESTART else None
        if self._path is None or outlives == self._kept:
            return
        self._kept = outlives
        entries = self._entries()
        entries.pop(self._port, None)
        if outlives is not None:
            entries[self._port] = asdict(outlives)
        self._path.parent.mkdir(parents=True, exist_ok=True)
        beside = self._path.with_suffix(".new")
        beside.write_text(json.dumps(entries, indent=1))
        beside.replace(self._path)

    def _entries(self) -> dict:
        if self._path is None or not self._path.is_file():
            return {}
        try:
            entries = json.loads(self._path.read_text())
        except ValueError as error:
            raise self._unreadable() from error
        if not isinstance(entries, dict):
            raise self._unreadable()
        return entries

    def _unreadable(self) -> PortError:
        return PortError(
            f"{self._path} cannot be read, so it is not known whether a fault was left:"
            " see to the supply, then remove it."
        )
