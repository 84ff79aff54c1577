# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What `ros2 param dump` writes of a node is taken back, when it runs and when it starts."""

from contextlib import suppress
from typing import Any

import pytest
import yaml
from hasel_bringup.processes import Processes
from rcl_interfaces.msg import Parameter, ParameterDescriptor, SetParametersResult
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import parameter_value_to_python

_TRIES = 6
NODES = {
    "hasel_driver": ("hasel_driver", "driver_node"),
    "hasel_tracker": ("hasel_tracker", "tracker_node"),
    "hasel_simulator": ("hasel_sim", "simulator"),
    "hasel_sysid": ("hasel_sysid", "sysid"),
    "hasel_recorder": ("hasel_bringup", "recorder"),
}


class Parameters:
    """Of one running node, as the ros2 tool sees them."""

    def __init__(self, listener, processes: Processes, node: str) -> None:
        self._listener, self._check, self._node = listener, processes.check, f"/hasel/{node}"

    def _call(self, kind: type, service: str, **request) -> Any:
        """The answer; asked again where none comes: a node that was just found may not know the way back yet."""
        name = f"{self._node}/{service}"
        for _ in range(_TRIES - 1):
            with suppress(AssertionError):
                return self._listener.call(kind, name, 10.0, self._check, **request)
        return self._listener.call(kind, name, 10.0, self._check, **request)

    def dump(self) -> dict[str, Any]:
        """All of them, by name."""
        names = self._call(ListParameters, "list_parameters").result.names
        values = self._call(GetParameters, "get_parameters", names=names).values
        pairs = zip(names, map(parameter_value_to_python, values), strict=True)
        return {name: list(value) if hasattr(value, "tolist") else value for name, value in pairs}

    def load(self) -> dict[str, SetParametersResult]:
        """Set every one to what it is; the answers by name."""
        names = list(self.dump())
        values = self._call(GetParameters, "get_parameters", names=names).values
        given = [Parameter(name=name, value=value) for name, value in zip(names, values, strict=True)]
        results = self._call(SetParameters, "set_parameters", parameters=given).results
        return dict(zip(names, results, strict=True))

    def described(self) -> dict[str, ParameterDescriptor]:
        """What ROS is told of each."""
        answer = self._call(DescribeParameters, "describe_parameters", names=list(self.dump()))
        return {each.name: each for each in answer.descriptors}


@pytest.mark.timeout(200)
@pytest.mark.parametrize("node", NODES)
def test_a_dump_is_taken_back(node, tmp_path, environment, listener):
    """Running, every value that may change is taken and all others stay; started with the dump, they are the same."""
    file = tmp_path / "dump.yaml"
    with Processes(tmp_path / "first", environment) as processes:
        processes.start(*NODES[node], "--ros-args", "-p", "autostart:=false")
        parameters = Parameters(listener, processes, node)
        before, described = parameters.dump(), parameters.described()
        refused = {name for name, result in parameters.load().items() if not result.successful}
        assert refused == {name for name in refused if described[name].read_only}
        assert refused < set(before)
        assert parameters.dump() == before
        file.write_text(yaml.safe_dump({f"/hasel/{node}": {"ros__parameters": before}}))
        assert processes.stop(NODES[node][1]) == 0
    with Processes(tmp_path / "second", environment) as processes:
        processes.start(*NODES[node], "--ros-args", "--params-file", str(file))
        assert Parameters(listener, processes, node).dump() == before
