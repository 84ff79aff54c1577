# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The process that alone talks to the supply: `python -m hasel_driver.safety.safety_process DESCRIPTOR`.

It shares no interpreter lock with ROS, so that nothing the node does can hold up the heartbeat, a check or a stop.
Over a socket that only the two hold, the node sends its parameters and then `Request`s, each a method of
`SafetyProcess`; it is told a `Snapshot` with every report of the supply, and an `Answer` to each request. The end of
the socket is the end of the node: the supply is disarmed, and this process ends.
"""

import contextlib
import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from multiprocessing.connection import Connection
from typing import Any

from hasel_driver.protocol import wire
from hasel_driver.protocol.faults import DriverError, Fault, FaultStore, LimitError
from hasel_driver.protocol.limits import limits_of
from hasel_driver.protocol.status import SupplyStatus
from hasel_driver.safety.driven_experiment import DrivenExperiment, ExperimentPlan
from hasel_driver.safety.supervisor import Supervisor
from hasel_driver.safety.supply_link import Answer, Request, Snapshot
from hasel_driver.safety.supply_thread import SupplyThread, request_realtime
from hasel_driver.supplies.hasel_supply import HaselSupply
from hasel_driver.supplies.serial_port import SerialPort
from hasel_driver.supplies.shvps import ShvpsSupply
from hasel_driver.supplies.supply import Supply

MOST_UNSENT = 1000  # snapshots; a node that takes no more in must not hold up the supply


def make_supply(parameters: Mapping[str, Any]) -> Supply:
    """A supply, not yet opened. Raises LimitError where a parameter makes no sense."""
    limits = limits_of(parameters)
    if parameters["backend"] == "hasel":
        return HaselSupply(SerialPort(parameters["port"], wire.BAUD), limits)
    if not parameters["second_port"]:
        raise LimitError(
            "The backend shvps drives one board for each muscle: set `second_port` to the lower one's."
        )
    return ShvpsSupply((SerialPort(parameters["port"]), SerialPort(parameters["second_port"])), limits)


class SafetyProcess:
    """Opens the supply; `tell` gets snapshots and answers. Raises DriverError where it cannot be opened."""

    def __init__(self, parameters: Mapping[str, Any], tell: Callable[[Snapshot | Answer], None]) -> None:
        self._tell = tell
        self._without_realtime = request_realtime(parameters["realtime_priority"])
        supply = make_supply(parameters)
        self._store = FaultStore(parameters["state_folder"], parameters["port"])
        self._supervisor = Supervisor(supply, time.monotonic, parameters["idle_disarm"])
        self._supervisor.fault = self._store.load()
        self._supervisor.connect()
        self._experiment: DrivenExperiment | None = None
        self._running = False  # the experiment's clock
        self.thread = SupplyThread(self._supervisor, supply, self._on_status, self._step)
        supervisor = self._supervisor
        self._methods: dict[str, Callable[..., Any]] = {
            "arm": supervisor.arm,
            "disarm": supervisor.disarm,
            "fail": supervisor.fail,
            "clear_fault": supervisor.clear_fault,
            "command": self._command,
            "await_zero": supervisor.await_zero,
            "lower_maximum": supervisor.lower_maximum,
            "begin_experiment": self._begin_experiment,
            "run_experiment": self._run_experiment,
            "cancel_experiment": self._cancel_experiment,
            "come_to_rest": lambda: None,
        }

    def serve(self, request: Request) -> None:
        """Do what is asked, in the supply's thread but for `host_is_alive` and `come_to_rest`, and answer."""
        if request.method == "host_is_alive":
            self.thread.host_is_alive(*request.arguments)
            return
        if request.method == "come_to_rest":
            self.thread.come_to_rest()
        method = self._methods[request.method]
        future = self.thread.call(lambda: method(*request.arguments))
        number = request.number
        if number is not None:
            future.add_done_callback(lambda done: self._tell(self._answer(number, done)))

    def snapshot(self) -> Snapshot:
        """The present state."""
        supervisor = self._supervisor
        return Snapshot(
            status=supervisor.status(),
            armed=supervisor.armed,
            connected=supervisor.connected,
            name=supervisor.name,
            limits=supervisor.limits,
            capabilities=supervisor.capabilities,
            refusal=supervisor.refusal,
            rejected_commands=supervisor.rejected_commands,
            garbled_lines=supervisor.garbled_lines,
            experiment=self._experiment.progress() if self._experiment is not None else None,
            without_realtime=self._without_realtime,
        )

    def _answer(self, number: int, done: Future[Any]) -> Answer:
        error = done.exception()
        if error is not None and not isinstance(error, Exception):
            raise error
        return Answer(number, None if error else done.result(), error, self.snapshot())

    def _on_status(self, status: SupplyStatus) -> None:
        self._keep(status.fault)
        self._tell(self.snapshot())

    def _keep(self, fault: Fault | None) -> None:
        try:
            self._store.keep(fault)
        except (OSError, DriverError) as error:
            print(f"hasel_driver: A restarted node will not know of {fault}: {error}", file=sys.stderr)

    def _command(self, voltage_v: Sequence[float], made_s: float) -> None:
        """As the supervisor's, `made_s` (monotonic) [s]: on its way here it has become older, too."""
        self._supervisor.command(voltage_v, time.monotonic() - made_s)

    def _begin_experiment(self, plan: ExperimentPlan) -> None:
        experiment = DrivenExperiment(plan, self._supervisor, time.monotonic)
        experiment.begin()
        self._experiment, self._running = experiment, False

    def _run_experiment(self) -> None:
        self._running = True

    def _cancel_experiment(self, reason: str) -> None:
        if self._experiment is not None:
            self._experiment.cancel(reason)

    def _step(self) -> None:
        if self._experiment is not None and self._running:
            self._experiment.step()


def main() -> int:
    """Serve the node at the other end of the socket until one of the two ends."""
    signal.signal(signal.SIGTERM, signal.SIG_IGN)  # a service manager's, to all: the node says how to end
    node = Connection(int(sys.argv[1]))
    outbox: queue.SimpleQueue[Snapshot | Answer | None] = queue.SimpleQueue()

    def tell(message: Snapshot | Answer) -> None:
        if isinstance(message, Answer) or outbox.qsize() < MOST_UNSENT:
            outbox.put(message)

    try:
        safety = SafetyProcess(node.recv(), tell)
    except DriverError as error:
        node.send(error)
        return 1
    except EOFError:
        return 1
    node.send(safety.snapshot())
    safety.thread.start()
    sender = threading.Thread(target=_send, args=(node, outbox), name="sender", daemon=True)
    sender.start()
    threading.Thread(target=_receive, args=(node, safety), name="receiver", daemon=True).start()
    safety.thread.join()
    outbox.put(None)
    sender.join(timeout=1.0)
    return 0


def _send(node: Connection, outbox: "queue.SimpleQueue[Snapshot | Answer | None]") -> None:
    while (message := outbox.get()) is not None:
        try:
            node.send(message)
        except OSError:
            return  # the node has ended, which the receiver notices too


def _receive(node: Connection, safety: SafetyProcess) -> None:
    try:
        with contextlib.suppress(EOFError, OSError):  # the node has ended
            while True:
                safety.serve(node.recv())
    finally:  # also where a request made no sense
        safety.thread.come_to_rest()
        safety.thread.stop()


if __name__ == "__main__":
    code = main()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)  # the receiver may still wait for the node
