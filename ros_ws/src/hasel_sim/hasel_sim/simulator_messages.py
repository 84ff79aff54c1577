"""Results of the live simulation as ROS messages."""

import math

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_recording.mcap_run import muscles
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from hasel_sim.drive.schedule import HASEL_CHANNELS
from hasel_sim.live.body_picture import COLOURS, region_triangles, skin_line
from hasel_sim.mesh.mesh import Mesh

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

    def _add(self, kind: int, name: str, nodes: np.ndarray, colour: tuple, scale: tuple) -> None:
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
