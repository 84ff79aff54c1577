"""A parameter of a node, known without ROS: for `--help`, the READMEs' tables and the core's own checks."""

from dataclasses import dataclass
from typing import Any

AUTOSTART = "autostart", True, "configure and activate at the start; false: wait for the lifecycle's services"
"""Of every node with a lifecycle: name, default and meaning."""


@dataclass(frozen=True)
class NodeParameter:
    """A number has a unit and a range from `low` to `high`, a text may have `choices`.

    Only a `changeable` one can be set while the node runs.
    """

    name: str
    default: Any
    description: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    changeable: bool = False

    @property
    def usage(self) -> tuple[str, Any, str]:
        """Name, default and meaning with unit and range, for `--help`."""
        span = "" if self.low is None else f", {self.low:g} to {self.high:g}"
        unit = f" [{self.unit}{span}]" if self.unit else ""
        return self.name, self.default, self.description + unit
