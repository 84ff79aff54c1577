"""What the node and its safety process say to each other."""

from dataclasses import dataclass
from typing import Any

from hasel_driver.experiment import ExperimentProgress
from hasel_driver.limits import Limits
from hasel_driver.status import SupplyStatus
from hasel_driver.supply import Capabilities


@dataclass(frozen=True)
class Snapshot:
    """All that the node knows of the supply; `refusal`: why it did not arm, in its own words."""

    status: SupplyStatus
    armed: bool
    connected: bool
    name: str | None
    limits: Limits
    capabilities: Capabilities
    refusal: str | None
    rejected_commands: int
    garbled_lines: int
    experiment: ExperimentProgress | None
    without_realtime: str | None  # why


@dataclass(frozen=True)
class Request:
    """A method of SafetyProcess and its arguments; a `number` of None wants no answer."""

    number: int | None
    method: str
    arguments: tuple[Any, ...] = ()


@dataclass(frozen=True)
class Answer:
    """What became of a request, and the supply after it."""

    number: int
    result: Any
    error: Exception | None
    snapshot: Snapshot
