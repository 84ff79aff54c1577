"""Parameters of a node as a table, declared with description, unit and range as `ros2 param describe` lists them."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node


@dataclass(frozen=True)
class NodeParameter:
    """One parameter; a number has a unit and a range; only a `changeable` one can be set while the node runs."""

    name: str
    default: Any
    description: str
    unit: str = ""
    low: float | None = None
    high: float | None = None
    changeable: bool = False

    @property
    def usage(self) -> tuple[str, Any, str]:
        """Name, default and meaning with unit and range, for `--help`."""
        span = "" if self.low is None else f", {self.low:g} to {self.high:g}"
        unit = f" [{self.unit}{span}]" if self.unit else ""
        return self.name, self.default, self.description + unit

    def descriptor(self) -> ParameterDescriptor:
        """What ROS tells about it and checks by itself."""
        unit = f" [{self.unit}]" if self.unit else ""
        descriptor = ParameterDescriptor(description=self.description + unit, read_only=not self.changeable)
        if self.low is not None and isinstance(self.default, float):
            span = FloatingPointRange(from_value=float(self.low), to_value=float(self.high))
            descriptor.floating_point_range = [span]
        elif self.low is not None:
            descriptor.integer_range = [
                IntegerRange(from_value=int(self.low), to_value=int(self.high), step=1)
            ]
        return descriptor


def declare(node: Node, table: Iterable[NodeParameter]) -> None:
    """Declare every parameter; rclpy raises for a value given from outside that is out of range."""
    for parameter in table:
        node.declare_parameter(parameter.name, parameter.default, parameter.descriptor())


def words(node: Node, name: str) -> tuple[str, ...]:
    """A list of words; ROS cannot tell the type of an empty list, so empty words are left out."""
    return tuple(word for word in node.get_parameter(name).value if word)
