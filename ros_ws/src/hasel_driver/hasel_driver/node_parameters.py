"""Declares the table of parameters in a node, and guards it."""

from collections.abc import Callable

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node

from hasel_driver.errors import LimitError
from hasel_driver.parameters import PARAMETERS


def declare(node: Node, in_use: Callable[[], bool]) -> None:
    """Declare every parameter; while `in_use` none can be changed: the board was set up with them."""
    for parameter in PARAMETERS:
        description = (
            f"{parameter.description} [{parameter.unit}]" if parameter.unit else parameter.description
        )
        descriptor = ParameterDescriptor(description=description)
        if parameter.low is not None:
            interval = FloatingPointRange(from_value=parameter.low, to_value=parameter.high)
            descriptor.floating_point_range = [interval]
        descriptor.additional_constraints = ", ".join(parameter.choices)
        node.declare_parameter(parameter.name, parameter.default, descriptor)
    table = {parameter.name: parameter for parameter in PARAMETERS}

    def check(changes) -> SetParametersResult:
        for change in changes:
            if change.name not in table:
                continue
            try:
                table[change.name].check(change.value)
            except LimitError as error:
                return SetParametersResult(successful=False, reason=str(error))
            if in_use():
                reason = f"{change.name} is in use: deactivate and clean up the node, then change it."
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(check)


def values(node: Node) -> dict:
    """The present value of every parameter."""
    return {parameter.name: node.get_parameter(parameter.name).value for parameter in PARAMETERS}
