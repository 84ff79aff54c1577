"""Parameters of a node as a table, declared with description, unit and range as `ros2 param describe` lists them."""

from collections.abc import Iterable

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.node import Node

from hasel_recording.node_parameter import NodeParameter


def descriptor(parameter: NodeParameter, checked_elsewhere: bool = False) -> ParameterDescriptor:
    """What ROS tells about a parameter and checks by itself.

    checked_elsewhere: its type and whether it may change are not left to ROS, for which 200 is no float.
    """
    unit = f" [{parameter.unit}]" if parameter.unit else ""
    told = ParameterDescriptor(
        description=parameter.description + unit,
        read_only=not (parameter.changeable or checked_elsewhere),
        dynamic_typing=checked_elsewhere,
    )
    if parameter.choices:
        told.additional_constraints = "one of " + ", ".join(parameter.choices)
    if parameter.low is not None and isinstance(parameter.default, float):
        span = FloatingPointRange(from_value=float(parameter.low), to_value=float(parameter.high))
        told.floating_point_range = [span]
    elif parameter.low is not None:
        span = IntegerRange(from_value=int(parameter.low), to_value=int(parameter.high), step=1)
        told.integer_range = [span]
    return told


def declare(node: Node, table: Iterable[NodeParameter]) -> None:
    """Declare every parameter; rclpy raises for a value given from outside that is out of range."""
    for parameter in table:
        node.declare_parameter(parameter.name, parameter.default, descriptor(parameter))


def words(node: Node, name: str) -> tuple[str, ...]:
    """A list of words; ROS cannot tell the type of an empty list, so empty words are left out."""
    return tuple(word for word in node.get_parameter(name).value if word)
