"""What is known of the ground contacts, numbered as in telemetry and in `SupplyState.msg`."""

from enum import IntEnum


class Ground(IntEnum):
    """Read in the order of what it is worth; a person may come near in PROVEN only, with a ground stick."""

    NOT = 0  # live, or nothing is known
    COMMANDED = 1  # the contacts are commanded to ground, and less than 200 V measured: not proven
    PROVEN = 2  # besides, read back from auxiliary contacts, or by how fast a charged muscle was discharged
