"""`ros2 run hasel_driver calibrate`: compares output and read-back with a probe, and corrects both on the board.

End the driver's node first; connect a calibrated high-voltage probe to the muscle's terminals. The voltages are put on
one after the other, and what the probe shows is asked for; an empty answer stops. The table is printed, and stored on
the board only after a `yes`. Run it once more to verify.
"""

import argparse
import sys
import time
from collections.abc import Callable, Sequence

from hasel_driver import protocol
from hasel_driver.board_handshake import BoardHandshake
from hasel_driver.calibration import Calibration
from hasel_driver.calibration_table import CalibrationTable, Point
from hasel_driver.errors import DriverError, RefusedError
from hasel_driver.faults import SupplyFaultError
from hasel_driver.hasel_supply import HaselSupply
from hasel_driver.limits import Limits
from hasel_driver.line_buffer import LineBuffer
from hasel_driver.mode import Mode
from hasel_driver.serial_port import SerialPort
from hasel_driver.supervisor import Supervisor
from hasel_driver.supply_thread import SupplyThread

CHANNELS = ("upper", "lower")
SETTLING_S = 1.0
VOLTAGES_V = "1000,2000,3000,4000,5000"


class CalibrationBench:
    """One supply, driven without ROS; a voltage is held until the next is asked for."""

    def __init__(self, port: str, limits: Limits) -> None:
        supply = HaselSupply(SerialPort(port, protocol.BAUD), limits)
        self._supervisor = Supervisor(supply, time.monotonic)
        self._supervisor.connect()
        self._voltage_v: tuple[float, float] | None = None
        self._thread = SupplyThread(self._supervisor, supply, lambda _: None, self._hold)
        self._thread.start()

    def arm(self) -> None:
        """Raises RefusedError where it does not come to that."""
        self._await(Mode.STANDBY)
        self._thread.call(self._supervisor.arm).result(timeout=5.0)
        self._await(Mode.ARMED)

    def monitor(self, channel: int, voltage_v: float) -> float:
        """Put a voltage [V] on a channel, and hold it; what the monitor says [V] once it has settled."""
        self._voltage_v = (voltage_v, 0.0) if channel == 0 else (0.0, voltage_v)
        time.sleep(SETTLING_S)
        status = self._supervisor.status()
        if status.mode is not Mode.ACTIVE:
            raise RefusedError(f"The supply left the voltage that was asked for: {status}.")
        return abs(status.measured_v[channel])

    def close(self) -> None:
        """Ground the output and close the port."""
        self._voltage_v = None
        self._thread.come_to_rest()
        self._thread.stop()

    def _hold(self) -> None:
        if self._voltage_v is not None:
            self._supervisor.command(self._voltage_v)

    def _await(self, mode: Mode) -> None:
        reached = self._thread.expect(lambda: self._supervisor.status().mode is mode, 1.0)
        if not reached.result(timeout=5.0):
            raise RefusedError(f"{mode.name} was expected, the state is {self._supervisor.status()}.")


def measure(
    port: str, channel: str, voltages_v: Sequence[float], probe: Callable[[float], float]
) -> CalibrationTable:
    """Put each voltage [V] on the channel, and ask `probe(asked)` for what is there in truth [V]."""
    limits = Limits(maximum_voltage_v=max(voltages_v))
    present = converse(port, limits, "GET", "CALIBRATION", channel)
    bench = CalibrationBench(port, limits)
    points = []
    try:
        bench.arm()
        for voltage_v in voltages_v:
            monitor_v = bench.monitor(CHANNELS.index(channel), voltage_v)
            points.append(Point(voltage_v, monitor_v, abs(probe(voltage_v))))
    finally:
        bench.close()
    return CalibrationTable(tuple(points), present)


def store(port: str, channel: str, corrections: Calibration) -> Calibration:
    """Store them on the board; what it applied."""
    return converse(port, Limits(), "SET", "CALIBRATION", channel, corrections.words())


def converse(port: str, limits: Limits, *words: str) -> Calibration:
    """One command about a calibration to a board that is opened for it; the calibration it answers."""
    serial_port = SerialPort(port, protocol.BAUD)
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
        return float(answer)
    except ValueError as error:
        raise RefusedError(f"{answer!r} is no number: stopped, nothing was stored.") from error


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line; 0 when the corrections were stored, or were not wanted."""
    parser = argparse.ArgumentParser(
        prog="calibrate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--port", default="/dev/ttyACM0", help="serial port of the supply")
    parser.add_argument("--channel", choices=CHANNELS, required=True, help="the muscle")
    parser.add_argument(
        "--voltages", default=VOLTAGES_V, help=f"in V, at least three (default: {VOLTAGES_V})"
    )
    options = parser.parse_args(arguments)
    try:
        voltages_v = [float(word) for word in options.voltages.split(",")]
    except ValueError:
        parser.error(f"--voltages is {options.voltages!r}, numbers in V with commas between were expected")
    try:
        table = measure(options.port, options.channel, voltages_v, _ask_probe)
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
