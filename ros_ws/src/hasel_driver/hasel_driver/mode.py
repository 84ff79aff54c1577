"""The four states of the supply, numbered as in `SupplyState.msg`."""

from enum import IntEnum


class Mode(IntEnum):
    """STANDBY and FAULT are grounded, ARMED is grounded at 0 V, ACTIVE drives the muscles."""

    STANDBY = 0
    ARMED = 1
    ACTIVE = 2
    FAULT = 3

    @property
    def may_be_live(self) -> bool:
        """Whether high voltage may be on the output in this mode."""
        return self in (Mode.ARMED, Mode.ACTIVE)
