# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The lifecycle manager with real nodes: up in order, the driver down when another node ends, all down when asked."""

import contextlib
import time

import pytest
from hasel_bringup.processes import Processes
from lifecycle_msgs.msg import State
from lifecycle_msgs.srv import GetState
from rclpy.client import Client
from std_srvs.srv import Trigger

PATIENCE_S = 60.0
ACTIVE, INACTIVE, UNCONFIGURED = (
    State.PRIMARY_STATE_ACTIVE,
    State.PRIMARY_STATE_INACTIVE,
    State.PRIMARY_STATE_UNCONFIGURED,
)


class Rig:
    """A driver on a virtual supply and a recorder, neither of which starts by itself, and their manager."""

    def __init__(self, processes: Processes, listener, folder) -> None:
        self._processes, self._listener = processes, listener
        self._clients: dict[str, Client] = {}
        port = folder / "port"
        processes.start("hasel_driver", "virtual_supply", "--link", str(port))
        listener.until(port.exists, PATIENCE_S, processes.check)
        parameters = [f"port:={port}", f"history_file:={folder}/history.jsonl", f"state_folder:={folder}"]
        self._start("hasel_driver", "driver_node", *parameters)
        self.start_recorder()
        processes.start(
            "hasel_bringup", "lifecycle_manager", "--ros-args", "-p", "nodes:=[hasel_driver, hasel_recorder]"
        )

    def start_recorder(self) -> None:
        """Start it, anew."""
        self._start("hasel_bringup", "recorder")

    def _start(self, package: str, name: str, *parameters: str) -> None:
        words = [word for each in ("autostart:=false", *parameters) for word in ("-p", each)]
        self._processes.start(package, name, "--ros-args", *words)

    def await_states(self, **expected: int) -> None:
        """Until these nodes are in these states, by their own word."""
        end_s = time.monotonic() + PATIENCE_S
        while (found := {name: self._state(name) for name in expected}) != expected:
            assert time.monotonic() < end_s, f"the states are {found}, expected {expected}"

    def ask(self, service: str) -> str:
        """The manager's answer."""
        name = f"/hasel/lifecycle_manager/{service}"
        return self._listener.call(Trigger, name, 10.0, self._processes.check).message

    def _state(self, name: str) -> int | None:
        """Its state; None where no answer comes, as of a node that has just been killed."""
        if name not in self._clients:
            self._clients[name] = self._listener.node.create_client(GetState, f"/hasel/{name}/get_state")
        future = self._clients[name].call_async(GetState.Request())
        with contextlib.suppress(AssertionError):
            self._listener.until(future.done, 2.0, self._processes.check)
            return future.result().current_state.id
        return None


@pytest.mark.timeout(300)
def test_the_driver_is_down_while_a_node_is_missing(tmp_path, environment, listener):
    """It is active again when that is back; `shutdown` takes all down, and `startup` up."""
    with Processes(tmp_path, environment) as processes:
        rig = Rig(processes, listener, tmp_path)
        rig.await_states(hasel_driver=ACTIVE, hasel_recorder=ACTIVE)
        processes.kill("recorder")
        rig.await_states(hasel_driver=INACTIVE)
        rig.start_recorder()
        rig.await_states(hasel_driver=ACTIVE, hasel_recorder=ACTIVE)
        assert rig.ask("shutdown").startswith("Going down.")
        rig.await_states(hasel_driver=UNCONFIGURED, hasel_recorder=UNCONFIGURED)
        assert rig.ask("startup").startswith("Going up.")
        rig.await_states(hasel_driver=ACTIVE, hasel_recorder=ACTIVE)
        assert "Traceback" not in processes.output("lifecycle_manager").read_text()
