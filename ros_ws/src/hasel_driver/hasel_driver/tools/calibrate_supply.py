# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_driver calibrate`: compares output and read-back with a probe, and corrects both on the board.

End the driver's node first; connect a calibrated high-voltage probe to the muscle's terminals. Each voltage is put on
only after a `yes`, and what the probe shows is asked for: without an answer for 10 s the output is grounded. An empty
answer stops, as do Ctrl-C, the interlock, and the driver's emergency stop by topic or service; where the driver runs in
another namespace, as /rig2, add `--ros-args -r __ns:=/rig2`. The table is printed, and stored on the board only after
another `yes`. Run it once more to verify.
"""

import argparse
import importlib.util
import math
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext

from hasel_common.command_entry import command
from hasel_common.node_parameter import user_arguments

from hasel_driver.nodes.parameters import PARAMETERS
from hasel_driver.protocol import wire
from hasel_driver.protocol.calibration import Calibration, CalibrationTable, Point
from hasel_driver.protocol.faults import (
    DriverError,
    Fault,
    FaultCode,
    FaultStore,
    RefusedError,
    SupplyFaultError,
)
from hasel_driver.protocol.limits import HARDWARE_MAXIMUM_V, MUSCLE_NAMES, PULSE_V, Limits
from hasel_driver.protocol.status import Mode
from hasel_driver.protocol.wire import LineBuffer
from hasel_driver.safety.supervisor import Supervisor
from hasel_driver.safety.supply_thread import SupplyThread
from hasel_driver.supplies.board_handshake import BoardHandshake
from hasel_driver.supplies.hasel_supply import HaselSupply
from hasel_driver.supplies.serial_port import SerialPort

LATCHED_S = 1.0  # within which a stop that is held already is heard, as at the driver's arming
SETTLING_S = 1.0
PATIENCE_S = 10.0  # without an answer, after which the output is grounded
VOLTAGES_V = "1000,2000,3000,4000,5000"
STATE_FOLDER = next(each.default for each in PARAMETERS if each.name == "state_folder")


@contextmanager
def stops_of_ros(stop: Callable[[str], None]) -> Iterator[None]:
    """Within it `stop(who)` is called for an emergency stop by topic, and by the service, which is answered.

    Both in the driver's namespace, which `--ros-args -r __ns:=…` changes as for any node; what is heard is said.
    """
    if importlib.util.find_spec("rclpy") is None:
        print("ROS 2 is not there: only the keyboard and the interlock stop.", file=sys.stderr)
        yield
        return
    from hasel_common.managed_node import BackgroundSpin, node_alone
    from hasel_common.topics import EMERGENCY_STOP, NAMESPACE, relative
    from std_srvs.srv import Trigger

    from hasel_driver.nodes.emergency_stop import StopHolders, StopTopic
    from hasel_driver.nodes.middleware import prepare

    def serve(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        stop("by service")
        response.success, response.message = (
            False,
            "Stopped; a calibration proves nothing: treat the output as live.",
        )
        return response

    prepare()
    node = node_alone("hasel_calibrate", namespace=NAMESPACE)
    topic = StopTopic(
        node, StopHolders(), lambda asserted, who: stop(f"by topic, from {who}") if asserted else None
    )
    service = node.create_service(Trigger, relative(EMERGENCY_STOP), serve)
    spin = BackgroundSpin(node, "stops", owns_context=True)
    time.sleep(LATCHED_S)
    print(_heard(service.service_name, node.get_topic_names_and_types() + node.get_service_names_and_types()))
    try:
        yield
    finally:
        spin.end()
        topic.destroy()
        spin.close()


def _heard(name: str, present: Iterable[tuple[str, list[str]]]) -> str:
    """What is heard, and what is there and is not, in words."""
    last = name.rpartition("/")[-1]
    others = sorted({each for each, _ in present if each.rpartition("/")[-1] == last} - {name})
    if not others:
        return f"Emergency stops are heard on {name}."
    return (
        f"Emergency stops are heard on {name} only, and there is {', '.join(others)} too: for the supply of another"
        " namespace, such as /rig2, add --ros-args -r __ns:=/rig2."
    )


class CalibrationBench:
    """One supply, driven without the node; a voltage is held for as long as somebody answers."""

    def __init__(self, port: str, limits: Limits) -> None:
        supply = HaselSupply(SerialPort(port, wire.BAUD), limits)
        self._supervisor = Supervisor(supply, time.monotonic)
        self._supervisor.connect()
        self._voltage_v: tuple[float, float] | None = None
        self._until_s = 0.0  # that it is held
        self._thread = SupplyThread(self._supervisor, supply, lambda _: None, self._hold)
        self._thread.start()

    def arm(self) -> None:
        """Raises RefusedError where it does not come to that."""
        self._await(Mode.STANDBY)
        self._thread.call(self._supervisor.arm).result(timeout=5.0)
        self._await(Mode.ARMED)
        self._thread.call(lambda: self._supervisor.command((0.0, 0.0))).result(timeout=5.0)

    def stop(self, who: str) -> None:
        """An emergency stop."""
        self._voltage_v = None
        self._thread.call(lambda: self._supervisor.fail(Fault(FaultCode.EMERGENCY_STOP, who)))

    def monitor(self, channel: int, voltage_v: float) -> float:
        """Put a voltage [V] on a channel, and hold it for PATIENCE_S; what the monitor says [V] once it has settled."""
        self._until_s = time.monotonic() + SETTLING_S + PATIENCE_S
        self._voltage_v = (voltage_v, 0.0) if channel == 0 else (0.0, voltage_v)
        time.sleep(SETTLING_S)
        self.require_held()
        return abs(self._supervisor.status().measured_v[channel])

    def require_held(self) -> None:
        """Raises RefusedError where the voltage that was asked for is on no more."""
        if time.monotonic() > self._until_s:
            raise RefusedError(f"Nobody answered for {PATIENCE_S:g} s: grounded, nothing was stored.")
        status = self._supervisor.status()
        if status.mode is not Mode.ACTIVE:
            raise RefusedError(f"The supply left the voltage that was asked for: {status}.")

    def ground(self) -> None:
        """0 V, still armed."""
        self._voltage_v = None
        self._thread.call(lambda: self._supervisor.command((0.0, 0.0))).result(timeout=5.0)

    def close(self) -> None:
        """Ground the output and close the port."""
        self._voltage_v = None
        self._thread.come_to_rest()
        self._thread.stop()

    def _hold(self) -> None:
        voltage_v = self._voltage_v
        if voltage_v is not None and time.monotonic() < self._until_s:
            self._supervisor.command(voltage_v)

    def _await(self, mode: Mode) -> None:
        reached = self._thread.expect(lambda: self._supervisor.status().mode is mode, 1.0)
        if not reached.result(timeout=5.0):
            raise RefusedError(f"{mode.name} was expected, the state is {self._supervisor.status()}.")


def measure(
    port: str,
    channel: str,
    voltages_v: Sequence[float],
    probe: Callable[[float], float],
    agree: Callable[[float], bool],
    maximum_v: float = Limits().maximum_voltage_v,
    listen: Callable[[Callable[[str], None]], AbstractContextManager[object]] = nullcontext,
) -> CalibrationTable:
    """Put each voltage [V] on the channel if `agree(asked)`, and ask `probe(asked)` for what is there in truth [V].

    listen: gives a context in which the stop handed to it is called whenever somebody asks for one.

    Raises:
        RefusedError: a voltage above `maximum_v`, or one that makes no sense; a stop, or no answer.
    """
    for voltage_v in voltages_v:
        if not 0.0 < voltage_v <= maximum_v:
            raise RefusedError(
                f"{voltage_v:g} V were asked for, more than 0 and at most {maximum_v:g} V were expected."
            )
    limits = Limits(maximum_voltage_v=maximum_v)
    present = converse(port, limits, "GET", "CALIBRATION", channel)
    bench = CalibrationBench(port, limits)
    points = []
    try:
        with listen(bench.stop):
            if not agree(PULSE_V):  # of the proof that arming begins with
                raise RefusedError("Stopped, nothing was stored.")
            bench.arm()
            for voltage_v in voltages_v:
                if not agree(voltage_v):
                    raise RefusedError("Stopped, nothing was stored.")
                monitor_v = bench.monitor(MUSCLE_NAMES.index(channel), voltage_v)
                probe_v = probe(voltage_v)
                bench.require_held()
                points.append(Point(voltage_v, monitor_v, abs(probe_v)))
                bench.ground()
    finally:
        bench.close()
    return CalibrationTable(tuple(points), present)


def store(port: str, channel: str, corrections: Calibration) -> Calibration:
    """Store them on the board; what it applied."""
    return converse(port, Limits(), "SET", "CALIBRATION", channel, corrections.words())


def converse(port: str, limits: Limits, *words: str) -> Calibration:
    """One command about a calibration to a board that is opened for it; the calibration it answers."""
    serial_port = SerialPort(port, wire.BAUD)
    serial_port.open()
    try:
        handshake = BoardHandshake(serial_port, LineBuffer(), time.monotonic)
        handshake.perform(limits)
        return Calibration(*(int(word) for word in handshake.transact(*words)[2:]))
    except SupplyFaultError as problem:
        raise RefusedError(f"The board on {port} failed: {problem}.") from problem
    finally:
        serial_port.close()


def _ask_probe(asked_v: float) -> float:
    answer = input(f"{asked_v:g} V are asked for. What does the probe show [V]? ")
    try:
        value = float(answer)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise RefusedError(f"{answer!r} is no number: stopped, nothing was stored.")
    return value


def _ask_leave(voltage_v: float) -> bool:
    return input(f"{voltage_v:g} V come next. Hands off, and type yes: ").strip() == "yes"


@command
def main(arguments: Sequence[str] | None = None) -> int:
    """Command line; 0 when the corrections were stored, or were not wanted."""
    parser = argparse.ArgumentParser(
        prog="calibrate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--port", default="/dev/ttyACM0", help="serial port of the supply")
    parser.add_argument("--channel", choices=MUSCLE_NAMES, required=True, help="the muscle")
    parser.add_argument(
        "--voltages", default=VOLTAGES_V, help=f"in V, at least three (default: {VOLTAGES_V})"
    )
    parser.add_argument(
        "--maximum-voltage",
        type=float,
        default=6000.0,
        help="in V: nothing above it is put on (default: 6000)",
    )
    parser.add_argument(
        "--forget", action="store_true", help="store no correction for the channel, as after a damaged EEPROM"
    )
    parser.add_argument(
        "--state-folder",
        default=STATE_FOLDER,
        help=f"of the driver's node, whose latched faults count here too (default: {STATE_FOLDER})",
    )
    options = parser.parse_args(user_arguments(sys.argv[1:] if arguments is None else arguments))
    try:
        voltages_v = [float(word) for word in options.voltages.split(",")]
    except ValueError:
        parser.error(f"--voltages is {options.voltages!r}, numbers in V with commas between were expected")
    if not all(map(math.isfinite, (options.maximum_voltage, *voltages_v))):
        parser.error("--voltages and --maximum-voltage are finite numbers in V")
    try:
        if options.forget:
            print(f"stored: {store(options.port, options.channel, Calibration()).words()}")
            return 0
        left = FaultStore(options.state_folder, options.port).load()
        if left is not None:
            raise RefusedError(
                f"The driver's node left a fault ({left}): clear it there first (clear_fault)."
            )
        table = measure(
            options.port,
            options.channel,
            voltages_v,
            _ask_probe,
            _ask_leave,
            min(options.maximum_voltage, HARDWARE_MAXIMUM_V),
            stops_of_ros,
        )
        print(table)
        corrections = table.corrections()
        print(f"corrections: {corrections.words()} (set gain, set offset, read gain, read offset)")
        if input("Store them on the board? Type yes: ").strip() == "yes":
            print(f"stored: {store(options.port, options.channel, corrections).words()}")
    except (DriverError, EOFError, KeyboardInterrupt) as error:
        print(str(error) or "Stopped, nothing was stored.", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
