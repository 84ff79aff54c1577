# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_bringup virtual_rig`: supply, swimmer and camera without hardware, on the topics of the real ones."""

import argparse
import contextlib
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from hasel_common.declared_parameters import declare, words
from hasel_common.endpoints import Role, frame_of, publisher, subscription
from hasel_common.node_process import RepeatedWarnings, run_node
from hasel_common.topics import MEASURED, NAMESPACE, STATE
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_sim.errors import HaselSimError
from hasel_sim.live.live_simulator import live_model
from hasel_sim.live.simulator_interface import angle_message, rig_voltage, to_nanoseconds
from rclpy.node import Node
from threadpoolctl import threadpool_limits

from hasel_bringup.bringup_parameters import VIRTUAL_BODY
from hasel_bringup.errors import BringupError
from hasel_bringup.hidden_truth.hidden import hidden_values, with_hidden
from hasel_bringup.virtual.seen_swimmer import CameraNoise, SeenBody

_PATIENCE_S = 15.0


class VirtualBodyNode(Node):
    """Hears the supply's state and publishes what a camera would see; nobody is told the hidden effects."""

    def __init__(self) -> None:
        super().__init__("hasel_virtual_body", namespace=NAMESPACE)
        self._frame_id = frame_of(self, "camera")
        declare(self, VIRTUAL_BODY)
        self._warnings = RepeatedWarnings()
        model, warning = live_model(self._value("model"))
        self._warn(warning)
        hidden = hidden_values(words(self, "hidden"), np.random.default_rng(self._value("seed")))
        self._body = SeenBody(with_hidden(model, hidden), self._value("frame_rate"))
        noise = (self._value(name) for name in ("white_noise", "coloured_noise", "correlation", "seed"))
        self._noise, self._offset = CameraNoise(*noise), self._value("offset")
        self._angles = publisher(self, BendingAngle, MEASURED, Role.SAMPLES)
        subscription(self, SupplyState, STATE, self._on_state, Role.EVERY_SAMPLE)

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _warn(self, sentence: str) -> None:
        sentence = sentence and self._warnings.to_say(sentence, time.monotonic())
        if sentence:
            self.get_logger().warning(sentence)

    def _on_state(self, state: SupplyState) -> None:
        angles, sentence = self._body.state(to_nanoseconds(state.header.stamp), rig_voltage(state))
        self._warn(sentence)
        for angle in angles:
            seen = angle.sin_theta + self._offset + self._noise.next()
            message = angle_message(angle.stamp_ns, float(np.clip(seen, -1.0, 1.0)), self._frame_id)
            self._angles.publish(message)


@contextlib.contextmanager
def supply_and_driver(namespace: str) -> Iterator[Callable[[], None]]:
    """The driver on a virtual board, in processes of their own; gives a check that raises BringupError once one ended.

    namespace: of the driver, such as /hasel.
    """
    processes: list[subprocess.Popen[bytes]] = []

    def check() -> None:
        if any(process.poll() is not None for process in processes):
            raise BringupError(
                "the driver or its virtual board has ended; see its message above, or run without them: --body-only"
            )

    with tempfile.TemporaryDirectory(prefix="hasel_") as folder:
        port = Path(folder) / "supply"
        board = ("hasel_driver.virtual.virtual_supply", "--link", str(port))
        driver = (
            *(
                "hasel_driver.nodes.driver_node",
                "--ros-args",
                "-r",
                f"__ns:={namespace}",
                "-p",
                f"port:={port}",
            ),
            *("-p", "history_file:=" + str(port.with_name("history.jsonl"))),
            *("-p", f"state_folder:={port.parent}"),
        )
        try:
            processes.append(_module(*board, stdout=subprocess.DEVNULL))
            _await_port(port, processes[0])
            processes.append(_module(*driver))
            yield check
        finally:
            for process in reversed(processes):
                process.terminate()
            for process in processes:
                try:
                    process.wait(5.0)
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()


def _module(*words: str, stdout: int | None = None) -> subprocess.Popen[bytes]:
    return subprocess.Popen([sys.executable, "-m", *words], stdin=subprocess.DEVNULL, stdout=stdout)


def _await_port(port: Path, board: subprocess.Popen[bytes]) -> None:
    end = time.monotonic() + _PATIENCE_S
    while not port.exists():
        if time.monotonic() > end or board.poll() is not None:
            raise BringupError(
                "the virtual supply did not open its port; run `ros2 run hasel_driver virtual_supply` to see why"
            )
        time.sleep(0.05)


def run(options: argparse.Namespace) -> int:
    """Run until interrupted; returns the exit code."""
    with threadpool_limits(1), contextlib.ExitStack() as stack:
        return run_node(lambda: _node(options, stack), errors=(HaselSimError, BringupError))


def _node(options: argparse.Namespace, stack: contextlib.ExitStack) -> VirtualBodyNode:
    """The body's node and, for as long as `stack` is open, a virtual supply that it watches."""
    node = VirtualBodyNode()
    if not options.body_only:
        node.create_timer(1.0, stack.enter_context(supply_and_driver(node.get_namespace())))
    return node
