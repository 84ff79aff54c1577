"""The model's parameters as parameters of the node, so that they can be changed while it runs."""

from collections.abc import Callable, Iterable
from math import isfinite

from hasel_common.declared_parameters import descriptor
from hasel_common.node_parameter import NodeParameter
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.exceptions import InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter

from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model, Parameter

PREFIX = "parameters."


class ModelParameters:
    """Keeps `parameters.<name>` of the node and the model's parameter <name> the same."""

    def __init__(self, node: Node, use: Callable[[Model], None]) -> None:
        self._node, self._use = node, use
        self._model: Model | None = None
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._apply)

    def declare(self, model: Model) -> Model:
        """Replace the declared parameters by this model's; values given from outside at the start go first."""
        first = self._model is None
        self.forget()
        values: dict[str, float] = {}
        try:
            for parameter in model.parameters.values():
                declared = self._node.declare_parameter(
                    PREFIX + parameter.name,
                    parameter.value,
                    _descriptor(parameter),
                    ignore_override=not first,
                )
                values[parameter.name] = declared.value
        except InvalidParameterValueException:
            self._undeclare(values)
            raise
        self._model = model.with_values(values)
        return self._model

    def forget(self) -> None:
        """Undeclare all of them."""
        model, self._model = self._model, None
        self._undeclare(model.parameters if model is not None else ())

    def _undeclare(self, names: Iterable[str]) -> None:
        for name in names:
            self._node.undeclare_parameter(PREFIX + name)

    def _changed(self, parameters: list[RosParameter]) -> Model:
        values = {p.name.removeprefix(PREFIX): p.value for p in parameters if p.name.startswith(PREFIX)}
        return self._model.with_values(values)

    def _check(self, parameters: list[RosParameter]) -> SetParametersResult:
        if self._model is None:
            return SetParametersResult(successful=True)
        try:
            self._changed(parameters)
        except HaselSimError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    def _apply(self, parameters: list[RosParameter]) -> None:
        if self._model is None or not any(p.name.startswith(PREFIX) for p in parameters):
            return
        self._model = self._changed(parameters)
        self._use(self._model)


def _descriptor(parameter: Parameter) -> ParameterDescriptor:
    bounded = isfinite(parameter.lower) and isfinite(parameter.upper)
    low, high = (parameter.lower, parameter.upper) if bounded else (None, None)
    described = "parameter of the model", parameter.unit
    return descriptor(
        NodeParameter(parameter.name, float(parameter.value), *described, low, high, changeable=True)
    )
