# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the simulation shows of itself in ROS: the model's parameters, and its results as messages."""

import math
from collections.abc import Callable, Iterable
from math import isfinite

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point
from hasel_common.declared_parameters import descriptor
from hasel_common.node_parameter import NodeParameter
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_recording.mcap_run import muscles
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.exceptions import InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter as RosParameter
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from hasel_sim.drive.schedule import HASEL_CHANNELS
from hasel_sim.errors import HaselSimError
from hasel_sim.mesh.mesh import Mesh, Region
from hasel_sim.model import Model, Parameter

COLOURS: dict[Region, tuple[float, float, float]] = {
    Region.SOFT: (0.80, 0.80, 0.82),
    Region.SPINE: (0.25, 0.25, 0.30),
    Region.UPPER_MUSCLE: (0.84, 0.37, 0.00),
    Region.LOWER_MUSCLE: (0.00, 0.45, 0.70),
}
"""Red, green and blue, 0 to 1; the muscles' are told apart by the colour-blind too."""

_CORNER_TRIANGLES = (0, 1, 2, 0, 2, 3)


def region_triangles(mesh: Mesh) -> dict[Region, np.ndarray]:
    """Node numbers of the corners of two triangles per element, [3 × triangles], by region."""
    triangles = mesh.elements[:, _CORNER_TRIANGLES]
    present = {region: triangles[mesh.region == region].ravel() for region in Region}
    return {region: corners for region, corners in present.items() if len(corners)}


def skin_line(mesh: Mesh) -> np.ndarray:
    """Node numbers at the ends of the outline's pieces, [2 × pieces]."""
    return np.concatenate([mesh.skin[:, :2], mesh.skin[:, 1:]], axis=1).ravel()


_OUTLINE_WIDTH_M = 0.0006
_MARKER_SIZE_M = 0.005


def to_time(stamp_ns: int) -> Time:
    """A stamp [ns] as a message."""
    return Time(sec=stamp_ns // 1_000_000_000, nanosec=stamp_ns % 1_000_000_000)


def to_nanoseconds(stamp: Time) -> int:
    """A message's stamp [ns]."""
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def rig_voltage(state: SupplyState) -> np.ndarray:
    """The voltages [V] that were commanded of upper and lower muscle, [2]; NaN where a state does not tell."""
    commanded = dict(zip(muscles(state), state.commanded_voltage, strict=False))
    return np.array([commanded.get(name, math.nan) for name in HASEL_CHANNELS])


def angle_message(stamp_ns: int, sin_theta: float, frame_id: str) -> BendingAngle:
    """A simulated angle; no camera has seen it, so there are no marker positions."""
    message = BendingAngle(header=Header(stamp=to_time(stamp_ns), frame_id=frame_id))
    message.sin_theta = sin_theta
    message.theta = math.asin(max(-1.0, min(1.0, sin_theta)))
    message.sin_theta_standard_deviation = math.nan
    message.valid = math.isfinite(sin_theta)
    return message


class BodyMessage:
    """The `/hasel/swimmer` message of one mesh and its markers; its points are moved, as making them anew is slow."""

    def __init__(self, mesh: Mesh, markers: int, frame_id: str) -> None:
        self._message = MarkerArray()
        self._nodes: list[np.ndarray] = []
        for region, corners in region_triangles(mesh).items():
            self._add(Marker.TRIANGLE_LIST, region.name.lower(), corners, COLOURS[region], (1.0, 1.0, 1.0))
        self._add(Marker.LINE_LIST, "skin", skin_line(mesh), (0.1, 0.1, 0.1), (_OUTLINE_WIDTH_M, 0.0, 0.0))
        self._add(Marker.SPHERE_LIST, "markers", np.arange(markers), (0.1, 0.3, 0.9), (_MARKER_SIZE_M,) * 3)
        for marker in self._message.markers:
            marker.header.frame_id = frame_id

    def _add(
        self,
        kind: int,
        name: str,
        nodes: np.ndarray,
        colour: tuple[float, float, float],
        scale: tuple[float, float, float],
    ) -> None:
        marker = Marker(ns=name, type=kind, action=Marker.ADD, id=0)
        marker.pose.orientation.w = 1.0
        marker.scale.x, marker.scale.y, marker.scale.z = scale
        marker.color = ColorRGBA(r=colour[0], g=colour[1], b=colour[2], a=1.0)
        marker.points = [Point() for _ in nodes]
        self._nodes.append(nodes)
        self._message.markers.append(marker)

    def moved(self, stamp_ns: int, position: np.ndarray, markers: np.ndarray) -> MarkerArray:
        """The message with nodal positions [m] [nodes, 2] and marker positions [m] [markers, 2] at a stamp [ns]."""
        stamp = to_time(stamp_ns)
        for marker, nodes in zip(self._message.markers, self._nodes, strict=True):
            marker.header.stamp = stamp
            places = (markers if marker.ns == "markers" else position)[nodes].tolist()
            for point, (x, y) in zip(marker.points, places, strict=True):
                point.x, point.y = x, y
        return self._message


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
