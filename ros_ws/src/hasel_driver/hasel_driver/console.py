"""`ros2 run hasel_driver console`: arm, ramp, hold and stop by hand, with the voltages shown live.

While a voltage is on, ANY KEY STOPS: the output is grounded and the driver is in FAULT.
"""

import signal
import sys
import time
from collections.abc import Callable, Iterator

from hasel_common.node_parameter import user_arguments
from hasel_interfaces.msg import SupplyState
from rclpy._rclpy_pybind11 import RCLError

from hasel_driver.console_link import ConsoleLink
from hasel_driver.console_options import HELP, parser
from hasel_driver.errors import DriverError, RefusedError
from hasel_driver.ground import Ground
from hasel_driver.keyboard import Keyboard
from hasel_driver.limits import Voltages
from hasel_driver.mode import Mode

PERIOD_S = 0.02
SHOW_S = 0.2
RATE_V_PER_S = 1000.0
SERVICES = {
    "arm": "arm",
    "disarm": "disarm",
    "stop": "emergency_stop",
    "release": "release_emergency_stop",
    "clear": "clear_fault",
}


def ramp(
    start_v: Voltages, end_v: Voltages, rate_v_per_s: float, period_s: float = PERIOD_S
) -> Iterator[Voltages]:
    """Voltages from `start_v` to `end_v` [V], both moving straight and arriving together, one for each period."""
    farthest_v = max(abs(b - a) for a, b in zip(start_v, end_v, strict=True))
    steps = max(1, -(-farthest_v // (rate_v_per_s * period_s)))
    for step in range(1, int(steps) + 1):
        upper, lower = (a + (b - a) * step / steps for a, b in zip(start_v, end_v, strict=True))
        yield upper, lower


def describe(state: SupplyState | None) -> str:
    """One line; what is not known is said."""
    if state is None:
        return "no state is heard: treat the output as live"
    pairs = zip(state.commanded_voltage, state.measured_voltage, state.current, strict=True)
    muscles = [
        f"{name} {measured:.0f} of {asked:.0f} V {1e6 * current:.0f} µA"
        for name, (asked, measured, current) in zip(("upper", "lower"), pairs, strict=True)
    ]
    proof = GROUND_WORDS[Ground(state.ground)]
    limit = f"limit {state.maximum_voltage:.0f} V"
    held = f"stop held by {', '.join(state.emergency_stop_holders)}" if state.emergency_stop_holders else ""
    words = [Mode(state.mode).name, *muscles, proof, limit, held, state.fault_text]
    return " | ".join(word for word in words if word)


GROUND_WORDS = {
    Ground.NOT: "NOT grounded",
    Ground.COMMANDED: "commanded to ground, NOT proven",
    Ground.PROVEN: "grounded",
}


class Console:
    """Obeys one line at a time."""

    def __init__(self, link: ConsoleLink, keyboard: Keyboard, tell: Callable[..., None] = print) -> None:
        self._link, self._keyboard, self._tell = link, keyboard, tell
        self._rate_v_per_s = RATE_V_PER_S

    def run(self) -> None:
        """Until `quit`, the end of the input, or Ctrl-C; then disarm."""
        self._tell(HELP)
        try:
            while (line := self._keyboard.line("hasel> ")) is not None and line.split() != ["quit"]:
                try:
                    self.obey(line)
                except DriverError as error:
                    self._tell(str(error))
        except KeyboardInterrupt:
            try:
                self._tell(self._link.trigger("emergency_stop"))
            except DriverError as error:
                self._tell(str(error))
        finally:
            state = self._link.state()
            if state is None or state.mode in (Mode.ARMED, Mode.ACTIVE):
                self._tell(self._link.trigger("disarm"))

    def obey(self, line: str) -> None:
        """Raises RefusedError for what is not understood, or not done."""
        name, *words = line.split() or [""]
        if name in SERVICES and not words:
            self._tell(self._link.trigger(SERVICES[name]))
        elif name == "ramp" and len(words) in (2, 3):
            self._drive(*(_number(word) for word in words))
        elif name == "rate" and len(words) == 1:
            self._rate_v_per_s = max(1.0, _number(words[0]))
        elif name == "limit" and len(words) == 1:
            self._tell(self._link.lower_limit(_number(words[0])))
        elif name == "state":
            self._tell(describe(self._link.state()))
        elif name:
            self._tell(f"{line!r} is not understood; expected is one of:\n{HELP}")

    def _drive(self, upper_v: float, lower_v: float, hold_s: float | None = None) -> None:
        state = self._link.await_mode(Mode.ARMED)
        if state is None or state.mode != Mode.ARMED:
            raise RefusedError(f"A ramp needs the state ARMED: {describe(state)}.")
        if hold_s is None and not self._keyboard.is_terminal:
            raise RefusedError("Without a terminal no key can stop: say for how many seconds to hold.")
        target_v, zero_v = (upper_v, lower_v), (0.0, 0.0)
        with self._link.commanding(), self._keyboard.single_keys():
            self._tell("ANY KEY STOPS\r")
            stopped = not (
                self._follow(ramp(zero_v, target_v, self._rate_v_per_s))
                and self._follow(_hold(target_v, hold_s))
                and self._follow(ramp(target_v, zero_v, self._rate_v_per_s))
            )
        self._tell("")
        if stopped:
            self._tell(self._link.trigger("emergency_stop"))

    def _follow(self, voltages_v: Iterator[Voltages]) -> bool:
        """Whether it came to its end without a key or a fault."""
        next_s, shown_s = time.monotonic(), 0.0
        for voltage_v in voltages_v:
            self._link.command(voltage_v)
            state = self._link.state()
            if time.monotonic() - shown_s > SHOW_S:
                shown_s = time.monotonic()
                self._tell(f"\r\x1b[K{describe(state)}", end="", flush=True)
            if self._keyboard.pressed() or state is None or state.mode == Mode.FAULT:
                return False
            next_s += PERIOD_S
            time.sleep(max(0.0, next_s - time.monotonic()))
        return True


def _hold(voltage_v: Voltages, duration_s: float | None) -> Iterator[Voltages]:
    end_s = None if duration_s is None else time.monotonic() + duration_s
    while end_s is None or time.monotonic() < end_s:
        yield voltage_v


def _number(word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        value = float("nan")
    if not abs(value) < float("inf"):
        raise RefusedError(f"{word!r} is no number: volts or seconds were expected.")
    return value


def main() -> int:
    """Command line; returns the exit code."""
    return run(parser().parse_args(user_arguments(sys.argv[1:])).namespace)


def run(namespace: str) -> int:
    """Obey what is typed until the end; returns the exit code."""
    try:
        link = ConsoleLink(namespace)
    except RCLError as error:  # as without the keys that are asked for
        print(f"console: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    for number in (signal.SIGTERM, signal.SIGHUP):  # as Ctrl-C: nobody is left who could stop
        signal.signal(number, signal.default_int_handler)
    try:
        Console(link, Keyboard()).run()
    except DriverError as error:
        print(error, file=sys.stderr)
        return 1
    finally:
        link.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
