"""Declares the table of parameters in a node, and guards it."""

from collections.abc import Callable
from typing import Any

from hasel_common.declared_parameters import descriptor
from hasel_common.names import nearest
from rcl_interfaces.msg import SetParametersResult
from rclpy.node import Node

from hasel_driver.backends import limits_of
from hasel_driver.errors import DriverError, LimitError
from hasel_driver.parameters import FOLDERS, LOWERABLE, PARAMETERS, DriverParameter

OF_ROS = {"use_sim_time", "start_type_description_service"}
TABLE = {parameter.name: parameter for parameter in PARAMETERS}


def declare(node: Node, in_use: Callable[[], bool], lower: Callable[[float], None]) -> None:
    """Declare every parameter; while `in_use` none can be changed, but for the limit handed to `lower`.

    Raises:
        LimitError: a value given at the start is out of range, or a name is misspelt.
    """
    _check_overrides(node)
    for parameter in PARAMETERS:
        node.declare_parameter(
            parameter.name, parameter.default, descriptor(parameter, checked_elsewhere=True)
        )
        parameter.check(node.get_parameter(parameter.name).value)

    def check(changes) -> SetParametersResult:
        try:
            for change in changes:
                if change.name in TABLE:
                    _check_change(TABLE[change.name], change.value, in_use(), lower)
            limits_of(values(node) | {change.name: change.value for change in changes})
        except DriverError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(check)


def values(node: Node) -> dict:
    """The present value of every parameter; whole numbers as floats where floats are meant."""
    return {
        parameter.name: parameter.convert(node.get_parameter(parameter.name).value)
        for parameter in PARAMETERS
    }


def _check_change(
    parameter: DriverParameter, value: Any, in_use: bool, lower: Callable[[float], None]
) -> None:
    parameter.check(value)
    if parameter.name in FOLDERS:
        raise LimitError(
            f"{parameter.name} is given at the start and stays: start the node anew with another one."
        )
    if not in_use:
        return
    if parameter.name != LOWERABLE:
        raise LimitError(f"{parameter.name} is in use: deactivate and clean up the node, then change it.")
    lower(float(value))


def _check_overrides(node: Node) -> None:
    """A misspelt parameter would be ignored without a word, and its default used."""
    for name, given in node._parameter_overrides.items():
        if name in TABLE:
            TABLE[name].check(given.value)
        elif name not in OF_ROS and not name.startswith("qos_overrides."):
            near = nearest(name, TABLE, similarity=0.4)
            hint = f": did you mean {near!r}?" if near else f", only {', '.join(TABLE)}."
            raise LimitError(f"There is no parameter {name!r}{hint}")
