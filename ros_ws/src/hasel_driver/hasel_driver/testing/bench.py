"""The driver's thread on a rig, without ROS."""

import time
from collections.abc import Callable
from typing import Any

from hasel_driver import protocol
from hasel_driver.ground import Ground
from hasel_driver.hasel_supply import HaselSupply
from hasel_driver.limits import Limits, Voltages
from hasel_driver.mode import Mode
from hasel_driver.serial_port import SerialPort
from hasel_driver.status import SupplyStatus
from hasel_driver.supervisor import Supervisor
from hasel_driver.supply_thread import SupplyThread
from hasel_driver.testing.rig import Rig


class Bench:
    """Connected on construction; `statuses` collects everything that the driver says."""

    def __init__(self, rig: Rig, limits: Limits | None = None) -> None:
        self.rig = rig
        self.statuses: list[SupplyStatus] = []
        self.host_alive = True
        self.port = SerialPort(rig.port, protocol.BAUD)
        supply = HaselSupply(self.port, limits or Limits())
        self.supervisor = Supervisor(supply, time.monotonic)
        self.supervisor.connect()
        self.thread = SupplyThread(self.supervisor, supply, self.statuses.append, self._step)
        self.thread.start()

    def _step(self) -> None:
        if self.host_alive:
            self.thread.host_is_alive("test")

    def call(self, method: Callable[..., Any], *arguments: Any) -> Any:
        """Call a method of the supervisor in its thread."""
        return self.thread.call(lambda: method(*arguments)).result(timeout=10)

    def status(self) -> SupplyStatus:
        """The present status."""
        return self.call(self.supervisor.status)

    def await_mode(self, mode: Mode, timeout_s: float = 2.0) -> None:
        """Until the supply reports this mode."""
        if not self.thread.expect(lambda: self.supervisor.status().mode is mode, timeout_s).result(
            timeout=timeout_s + 5
        ):
            raise AssertionError(f"{mode.name} was expected, the state is {self.status()}")

    def arm(self) -> None:
        """Arm, and wait for the proof."""
        self.await_mode(Mode.STANDBY)
        self.call(self.supervisor.arm)
        self.await_mode(Mode.ARMED)
        self.call(self.supervisor.command, (0.0, 0.0))  # with which every controller begins

    def command_until(
        self,
        condition: Callable[[], bool],
        voltage_v: Voltages = (3000.0, -2000.0),
        timeout_s: float = 2.0,
    ) -> bool:
        """Command `voltage_v` at 100 Hz until `condition()`; whether it came true."""
        end_s = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > end_s:
                return False
            self.call(self.supervisor.command, voltage_v)
            time.sleep(0.01)
        return True

    def wait_until(self, condition: Callable[[], bool], timeout_s: float = 2.0) -> bool:
        """Wait without a command until `condition()`; whether it came true."""
        end_s = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > end_s:
                return False
            time.sleep(0.002)
        return True

    def false_claims(self) -> list[str]:
        """Statuses that called the output grounded, or claimed STANDBY or ARMED, while it was live in truth."""
        return [
            str(status)
            for status in list(self.statuses)
            if (status.ground is Ground.PROVEN or status.mode in (Mode.STANDBY, Mode.ARMED))
            and self.rig.refutes_dead_at(status.time_s)
        ]

    def close(self) -> None:
        """End the thread."""
        self.thread.stop()
