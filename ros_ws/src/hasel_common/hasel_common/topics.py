# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The topics of the stack: their names in the default namespace, relative to it, and their types."""

NAMESPACE = "/hasel"  # of a rig that is given no other: `--ros-args -r __ns:=/rig2`
COMMAND = "/hasel/command"
EMERGENCY_STOP = "/hasel/emergency_stop"
STATE = "/hasel/state"
DRIVE = "/hasel/drive"  # of bodies that other channels than the supply's two voltages drive
MEASURED = "/hasel/bending/measured"
SIMULATED = "/hasel/bending/simulated"
MARKERS = "/hasel/markers/measured"  # head, middle, tail [m] of recordings from before MEASURED had metres
SWIMMER = "/hasel/swimmer"
ERROR = "/hasel/error"
FIT = "/hasel/fit"
DIAGNOSIS = "/hasel/diagnosis"
DIAGNOSTICS = "/diagnostics"  # of all nodes, whatever their namespace

TOPIC_TYPES = {
    COMMAND: "hasel_interfaces/msg/Actuation",
    EMERGENCY_STOP: "std_msgs/msg/Bool",
    STATE: "hasel_interfaces/msg/SupplyState",
    DRIVE: "hasel_interfaces/msg/DriveSignal",
    MEASURED: "hasel_interfaces/msg/BendingAngle",
    SIMULATED: "hasel_interfaces/msg/BendingAngle",
    MARKERS: "geometry_msgs/msg/PoseArray",
    SWIMMER: "visualization_msgs/msg/MarkerArray",
    FIT: "hasel_interfaces/msg/Fit",
    DIAGNOSIS: "hasel_interfaces/msg/Diagnosis",
    ERROR: "hasel_interfaces/msg/RunningError",
    DIAGNOSTICS: "diagnostic_msgs/msg/DiagnosticArray",
}

FRAMES = {
    COMMAND: "hasel/supply",
    STATE: "hasel/supply",
    DRIVE: "hasel/supply",
    MEASURED: "hasel/camera",
    SIMULATED: "hasel/swimmer",
}
"""`header.frame_id` of messages that no node has stamped: those made from a file."""


def relative(topic: str) -> str:
    """Return the name as a node gives it, for ROS to put into the node's namespace and to remap."""
    return topic.removeprefix(f"{NAMESPACE}/")


def known_as(topic: str) -> str | None:
    """Return which topic of TOPIC_TYPES this is in some namespace, or relative to one; None for another."""
    for known in TOPIC_TYPES:
        if topic in (known, relative(known)) or topic.endswith(f"/{relative(known)}"):
            return known
    return None
