# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Parameters of a node as a table, declared with description, unit and range as `ros2 param describe` lists them."""

from array import array
from collections.abc import Iterable

from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException, InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter

from hasel_common.names import nearest
from hasel_common.node_parameter import NodeParameter


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
    if parameter.span is not None:
        low, high = parameter.span
        if isinstance(parameter.default, float):
            told.floating_point_range = [FloatingPointRange(from_value=float(low), to_value=float(high))]
        else:
            told.integer_range = [IntegerRange(from_value=int(low), to_value=int(high), step=1)]
    return told


def declare(node: Node, table: Iterable[NodeParameter]) -> None:
    """Declare every parameter, with what was given from outside in the type that its default has.

    The command line writes 30 for 30.0, and 0 for a source that is called "0": a whole number is taken for a number, a
    number for a name. Ends the process with a sentence for a value that does not fit and for a name that is nearly one
    of the table; rclpy raises for a default that is out of its own range.
    """
    by_name = {parameter.name: parameter for parameter in table}
    given = node._parameter_overrides  # rclpy says nowhere else what was given
    for name in [name for name in given if name not in by_name and "." not in name]:
        near = nearest(name, by_name, similarity=0.8)
        if near is not None and not node.has_parameter(name):
            raise SystemExit(f"error: there is no parameter {name}: did you mean {near}?")
    for name, parameter in by_name.items():
        if name in given:
            given[name] = _fitting(parameter, given[name])
        try:
            node.declare_parameter(name, parameter.default, descriptor(parameter))
        except (InvalidParameterTypeException, InvalidParameterValueException):
            if name not in given:
                raise
            raise SystemExit(f"error: {_refusal(parameter, given[name].value)}") from None
    node.add_pre_set_parameters_callback(
        lambda changes: [_fitting(by_name[c.name], c) if c.name in by_name else c for c in changes]
    )


def _fitting(parameter: NodeParameter, given: Parameter) -> Parameter:
    """The same value in the type of the default, where that loses nothing; else as it is."""
    value = given.value
    if isinstance(parameter.default, list):
        like = parameter.default[0] if parameter.default else ""
        value = value if isinstance(value, (list, tuple, array)) else [value]
        return Parameter(given.name, value=[_like(like, each) for each in value])
    return Parameter(given.name, value=_like(parameter.default, value))


def _like(default: object, value: object) -> object:
    if isinstance(default, bool) or isinstance(value, bool):
        return str(value).lower() if isinstance(default, str) else value
    if isinstance(default, float) and isinstance(value, int):
        return float(value)
    if isinstance(default, int) and isinstance(value, float) and value.is_integer():
        return int(value)
    if isinstance(default, str) and isinstance(value, (int, float)):
        return f"{value:.15g}"
    return value


def _refusal(parameter: NodeParameter, value: object) -> str:
    kind = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}.get(
        type(parameter.default), "a list"
    )
    span = "" if parameter.low is None else f" from {parameter.low:g} to {parameter.high:g}"
    unit = "" if parameter.unit in ("", "1") else f" {parameter.unit}"
    return (
        f"the parameter {parameter.name} is {value!r}; expected {kind}{span}{unit} ({parameter.description}), such as "
        f"{parameter.default!r}"
    )


def words(node: Node, name: str) -> tuple[str, ...]:
    """A list of words; ROS cannot tell the type of an empty list, so empty words are left out."""
    return tuple(word for word in node.get_parameter(name).value if word)
