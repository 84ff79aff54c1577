# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The node's parameters: their table, which the README lists, their declaration in the node, and their guard."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hasel_common.names import nearest
from hasel_common.node_parameter import NodeParameter

from hasel_driver.protocol.faults import DriverError, LimitError
from hasel_driver.protocol.limits import limits_of

if TYPE_CHECKING:  # commands that need the table only do without rclpy
    from rclpy.node import Node
    from rclpy.parameter import Parameter

LOWERABLE = "maximum_voltage"  # the one that may be changed, downwards, while it is in use
FOLDERS = {"state_folder", "recording_directory", "waveform_directory", "history_file"}
"""Where files are read and written: said at the start only, as whoever is on the network can set a parameter."""
OF_ROS = {"use_sim_time", "start_type_description_service"}


class DriverParameter(NodeParameter):
    """One parameter, checked by ourselves with a sentence."""

    def check(self, value: Any) -> None:
        """Raises LimitError for a value of another kind, or outside range or choices."""
        kind = self._kind(value)
        if kind != self._kind(self.default) and (kind, self._kind(self.default)) != (
            "whole number",
            "number",
        ):
            raise LimitError(f"{self.name} is {value!r}, a {self._kind(self.default)} was expected.")
        if self.span is not None:
            low, high = self.span
            if not low <= float(value) <= high:  # nor NaN
                raise LimitError(f"{self.name} is {value} {self.unit}, {low:g} to {high:g} was expected.")
        if self.choices and value not in self.choices:
            near = nearest(str(value).lower(), self.choices, similarity=0.4)
            hint = f" Did you mean {near}?" if near else ""
            raise LimitError(
                f"{self.name} is {value!r}, one of {', '.join(self.choices)} was expected.{hint}"
            )

    def convert(self, value: Any) -> Any:
        """A whole number as a float where a float is meant."""
        if isinstance(self.default, list):
            return list(value or [])  # ROS cannot tell the type of an empty list
        return float(value) if isinstance(self.default, float) else value

    @staticmethod
    def _kind(value: object) -> str:
        if isinstance(value, bool):
            return "truth value"
        if isinstance(value, (int, float)):
            return "whole number" if isinstance(value, int) else "number"
        return "text" if isinstance(value, str) else "list of texts"


PARAMETERS: tuple[DriverParameter, ...] = (
    DriverParameter("port", "/dev/ttyACM0", "serial port of the supply (with shvps: of the upper muscle's)"),
    DriverParameter("backend", "hasel", "protocol of the supply", choices=("hasel", "shvps")),
    DriverParameter("second_port", "", "serial port of the lower muscle's supply (shvps only)"),
    DriverParameter(
        "maximum_voltage",
        6000.0,
        "commands are clipped to ± this; may be lowered at any time",
        "V",
        0.0,
        9800.0,
    ),
    DriverParameter(
        "slew_rate", 250e3, "steepest change of the set point (before 0.2.0 in V/ms)", "V/s", 1e3, 2e6
    ),
    DriverParameter(
        "trip_current", 450e-6, "converter current at which the board latches a fault", "A", 1e-6, 9.8e-4
    ),
    DriverParameter(
        "heartbeat_timeout", 0.3, "silence after which the board grounds its output", "s", 0.1, 0.45
    ),
    DriverParameter(
        "dead_time",
        0.005,
        "between opening and closing relays: at least their release time and bounce by the data sheet",
        "s",
        0.002,
        0.05,
    ),
    DriverParameter(
        "load_capacitance",
        4.5e-9,
        "of the largest muscle with its cable, whose discharge counts in the half second to ground",
        "F",
        0.0,
        1e-8,
    ),
    DriverParameter(
        "contacts_read_back", False, "auxiliary contacts of the ground relays are wired to the board"
    ),
    DriverParameter(
        "idle_disarm", 60.0, "armed without a command or an experiment for so long: disarm", "s", 1.0, 3600.0
    ),
    DriverParameter(
        "state_folder", "~/.ros/hasel_driver", "where faults that outlive a restart are kept; empty: nowhere"
    ),
    DriverParameter(
        "discovery_time", 1.0, "arming waits this long for a latched emergency stop", "s", 0.0, 60.0
    ),
    DriverParameter(
        "accept_no_deadman", False, "allow arming a supply that stays live when its host dies (shvps)"
    ),
    DriverParameter(
        "recording_directory", "recordings", "below which RunExperiment writes, and nowhere else"
    ),
    DriverParameter(
        "waveform_directory", "waveforms", "below which the waveform files of goals lie, and nowhere else"
    ),
    DriverParameter(
        "history_file",
        "~/.ros/hasel_supply_history.jsonl",
        "where faults, breakdowns and leakage are noted for good; empty: nowhere",
    ),
    DriverParameter(
        "recorded_topics",
        ["bending/measured", "markers/measured", "bending/simulated"],
        "recorded with the state; required in the recording when published as the experiment begins",
    ),
    DriverParameter(
        "realtime_priority",
        40,
        "of the threads that send commands, where the system allows it; 0: none",
        "",
        0,
        90,
    ),
    DriverParameter("autostart", True, "configure and activate at start (never arms)"),
)


TABLE = {parameter.name: parameter for parameter in PARAMETERS}


def declare(node: "Node", in_use: Callable[[], bool], lower: Callable[[float], None]) -> None:
    """Declare every parameter; while `in_use` none can be changed, but for the limit handed to `lower`.

    What is set to what it is changes nothing, and is taken.

    Raises:
        LimitError: a value given at the start is out of range, or a name is misspelt.
    """
    from hasel_common.declared_parameters import descriptor
    from rcl_interfaces.msg import SetParametersResult

    _check_overrides(node)
    for parameter in PARAMETERS:
        node.declare_parameter(
            parameter.name, parameter.default, descriptor(parameter, checked_elsewhere=True)
        )
        parameter.check(node.get_parameter(parameter.name).value)

    def check(changes: "Sequence[Parameter]") -> SetParametersResult:
        try:
            for change in changes:
                if change.name in TABLE and change.value != node.get_parameter(change.name).value:
                    _check_change(TABLE[change.name], change.value, in_use(), lower)
            limits_of(values(node) | {change.name: change.value for change in changes})
        except DriverError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(check)


def values(node: "Node") -> dict[str, Any]:
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


def _check_overrides(node: "Node") -> None:
    """A misspelt parameter would be ignored without a word, and its default used."""
    for name, given in node._parameter_overrides.items():
        if name in TABLE:
            TABLE[name].check(given.value)
        elif name not in OF_ROS and not name.startswith("qos_overrides."):
            near = nearest(name, TABLE, similarity=0.4)
            hint = f": did you mean {near!r}?" if near else f", only {', '.join(TABLE)}."
            raise LimitError(f"There is no parameter {name!r}{hint}")


def check_files(node_name: str, full_name: str, arguments: Sequence[str]) -> None:
    """Raises LimitError for a section of a parameter file that names this node in another namespace only.

    ROS would ignore it without a word, limits and all. arguments: the process's command line.
    """
    import yaml

    for word, path in zip(arguments, arguments[1:], strict=False):
        if word != "--params-file":
            continue
        # No more than names and nesting is read, as launch_ros writes tags of Python: BaseLoader.
        sections = list(_sections(yaml.load(Path(path).read_text(), yaml.BaseLoader) or {}))
        meant = [name for name in sections if name.rpartition("/")[2] == node_name]
        if meant and full_name not in meant and not any("*" in name for name in sections):
            raise LimitError(
                f"{path} has parameters for {', '.join(meant)}, but this node is {full_name}, so they would be ignored:"
                f" write /**/{node_name} there."
            )


def _sections(tree: dict[str, Any], above: str = "") -> Iterator[str]:
    """The full names of the nodes that a parameter file speaks of."""
    for key, content in tree.items():
        name = f"{above}/{str(key).strip('/')}"
        if isinstance(content, dict):
            if "ros__parameters" in content:
                yield name
            yield from _sections({k: v for k, v in content.items() if k != "ros__parameters"}, name)
