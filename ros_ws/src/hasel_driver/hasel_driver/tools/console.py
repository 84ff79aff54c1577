# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_driver console`: arm, ramp, hold and stop by hand; its keyboard, and its link to the driver."""

import os
import select
import signal
import sys
import termios
import threading
import time
import tty
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import rclpy
from hasel_common.endpoints import Role, frame_of, publisher, subscription
from hasel_common.managed_node import BackgroundSpin
from hasel_common.topics import COMMAND, NAMESPACE, STATE
from hasel_interfaces.msg import Actuation, SupplyState
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy._rclpy_pybind11 import RCLError
from rclpy.publisher import Publisher
from std_srvs.srv import Trigger

from hasel_driver.protocol.faults import DriverError, RefusedError
from hasel_driver.protocol.limits import MUSCLE_NAMES, Voltages
from hasel_driver.protocol.status import Ground, Mode

ANSWER_S = 5.0
FRESH_S = 0.5
CLAIM_PERIOD_S = 0.02
TO_GROUND = {"emergency_stop", "disarm"}  # which are sent however many answer
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
GROUND_WORDS = {
    Ground.NOT: "NOT grounded",
    Ground.COMMANDED: "commanded to ground, NOT proven",
    Ground.PROVEN: "grounded",
}


class Keyboard:
    """Standard input; `pressed` is always False where it is no terminal."""

    def __init__(self) -> None:
        self.is_terminal = sys.stdin.isatty()

    def line(self, prompt: str) -> str | None:
        """The next line; None at the end of the input."""
        try:
            return input(prompt if self.is_terminal else "")
        except EOFError:
            return None

    @contextmanager
    def single_keys(self) -> Iterator[None]:
        """Within, keys are seen at once and not echoed; Ctrl-C is a key like any other."""
        if not self.is_terminal:
            yield
            return
        before = termios.tcgetattr(sys.stdin)
        tty.setraw(sys.stdin, termios.TCSANOW)
        termios.tcflush(sys.stdin, termios.TCIFLUSH)
        try:
            yield
        finally:
            termios.tcsetattr(sys.stdin, termios.TCSANOW, before)

    def pressed(self) -> bool:
        """Whether a key was pressed since the last call, within `single_keys`."""
        if not self.is_terminal:
            return False
        ready, _, _ = select.select([sys.stdin], [], [], 0.0)
        if not ready:
            return False
        os.read(sys.stdin.fileno(), 1024)
        return True


class ConsoleLink:
    """A node of its own, spun in the background; `command` publishes only within `commanding`."""

    def __init__(self, namespace: str = NAMESPACE) -> None:
        rclpy.init()
        self._node = rclpy.create_node(f"hasel_console_{os.getpid()}", namespace=namespace)
        self._state: SupplyState | None = None
        self._heard_s = 0.0
        self._commands: Publisher | None = None
        subscription(self._node, SupplyState, STATE, self._take, Role.SAMPLES)
        self._clients: dict[str, Any] = {}
        self._spin = BackgroundSpin(self._node, "console", owns_context=True)

    def state(self) -> SupplyState | None:
        """The last state, if it is of now."""
        return self._state if time.monotonic() - self._heard_s < FRESH_S else None

    def await_mode(self, mode: int) -> SupplyState | None:
        """The last state; one that is about to have this mode is waited for."""
        end_s = time.monotonic() + FRESH_S
        while time.monotonic() < end_s and (self._state is None or self._state.mode != mode):
            time.sleep(0.01)
        return self.state()

    def trigger(self, name: str) -> str:
        """Call one of the driver's services; its words. Raises RefusedError with them where it fails."""
        answer = self._ask(Trigger, name, Trigger.Request())
        if not answer.success:
            raise RefusedError(answer.message)
        return answer.message

    def lower_limit(self, voltage_v: float) -> str:
        """Lower the driver's maximum voltage [V]."""
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=voltage_v)
        request = SetParameters.Request(parameters=[Parameter(name="maximum_voltage", value=value)])
        (result,) = self._ask(SetParameters, "hasel_driver/set_parameters", request).results
        if not result.successful:
            raise RefusedError(result.reason)
        return f"The limit is {voltage_v:g} V."

    @contextmanager
    def commanding(self) -> Iterator[None]:
        """The driver obeys one publisher of commands: this one is there only as long as it is needed.

        Raises RefusedError where that is another.
        """
        self._commands = publisher(self._node, Actuation, COMMAND, Role.COMMANDS)
        try:
            end_s = time.monotonic() + ANSWER_S
            while (holder := self._holder()) != self._node.get_fully_qualified_name():
                if time.monotonic() > end_s:
                    raise RefusedError(
                        f"The driver obeys {holder or 'nobody'}: end that node, or disarm and arm again."
                    )
                self.command((0.0, 0.0))  # with which every controller begins
                time.sleep(CLAIM_PERIOD_S)
            yield
        finally:
            self._node.destroy_publisher(self._commands)
            self._commands = None

    def command(self, voltage_v: Voltages) -> None:
        """Publish one command."""
        message = Actuation(voltage=list(voltage_v))
        message.header.frame_id = frame_of(self._node, "supply")
        message.header.stamp = self._node.get_clock().now().to_msg()
        if self._commands is None:
            raise RefusedError("Nothing is commanded now: do it within `commanding`.")
        self._commands.publish(message)

    def close(self) -> None:
        """Leave."""
        self._spin.close()

    def _holder(self) -> str:
        state = self.state()
        return state.commander if state else ""

    def _take(self, state: SupplyState) -> None:
        self._state, self._heard_s = state, time.monotonic()

    def _ask(self, kind: type, name: str, request: Any) -> Any:
        if name not in self._clients:
            self._clients[name] = self._node.create_client(kind, name)
        client = self._clients[name]
        if client.wait_for_service(ANSWER_S):
            answering = self._node.count_services(client.srv_name)
            refusal = (
                f"{answering} nodes answer {client.srv_name}, and one answer would stand for all: stop each supply"
                " by its switch, and end all but one."
            )
            if answering > 1 and name not in TO_GROUND:
                raise RefusedError(refusal)
            done = threading.Event()
            future = client.call_async(request)
            future.add_done_callback(lambda _: done.set())
            answered = done.wait(ANSWER_S)
            if answering > 1:
                raise RefusedError(f"It was sent, but {refusal}")
            if answered:
                return future.result()
        raise RefusedError(
            f"{client.srv_name} gives no answer: start the driver's node, or treat the output as live."
        )


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
        for name, (asked, measured, current) in zip(MUSCLE_NAMES, pairs, strict=True)
    ]
    proof = GROUND_WORDS[Ground(state.ground)]
    limit = f"limit {state.maximum_voltage:.0f} V"
    held = f"stop held by {', '.join(state.emergency_stop_holders)}" if state.emergency_stop_holders else ""
    words = [Mode(state.mode).name, *muscles, proof, limit, held, state.fault_text]
    return " | ".join(word for word in words if word)


class Console:
    """Obeys one line at a time; `usage` is what it understands, in words."""

    def __init__(self, link: ConsoleLink, keyboard: Keyboard, usage: str) -> None:
        self._link, self._keyboard, self._usage = link, keyboard, usage
        self._rate_v_per_s = RATE_V_PER_S

    def run(self) -> None:
        """Until `quit`, the end of the input, or Ctrl-C; then disarm."""
        print(self._usage)
        try:
            while (line := self._keyboard.line("hasel> ")) is not None and line.split() != ["quit"]:
                try:
                    self.obey(line)
                except DriverError as error:
                    print(str(error))
        except KeyboardInterrupt:
            try:
                print(self._link.trigger("emergency_stop"))
            except DriverError as error:
                print(str(error))
        finally:
            state = self._link.state()
            if state is None or state.mode in (Mode.ARMED, Mode.ACTIVE):
                print(self._link.trigger("disarm"))

    def obey(self, line: str) -> None:
        """Raises RefusedError for what is not understood, or not done."""
        name, *words = line.split() or [""]
        if name in SERVICES and not words:
            print(self._link.trigger(SERVICES[name]))
        elif name == "ramp" and len(words) in (2, 3):
            self._drive(*(_number(word) for word in words))
        elif name == "rate" and len(words) == 1:
            self._rate_v_per_s = max(1.0, _number(words[0]))
        elif name == "limit" and len(words) == 1:
            print(self._link.lower_limit(_number(words[0])))
        elif name == "state":
            print(describe(self._link.state()))
        elif name:
            print(f"{line!r} is not understood; expected is one of:\n{self._usage}")

    def _drive(self, upper_v: float, lower_v: float, hold_s: float | None = None) -> None:
        state = self._link.await_mode(Mode.ARMED)
        if state is None or state.mode != Mode.ARMED:
            raise RefusedError(f"A ramp needs the state ARMED: {describe(state)}.")
        if hold_s is None and not self._keyboard.is_terminal:
            raise RefusedError("Without a terminal no key can stop: say for how many seconds to hold.")
        target_v, zero_v = (upper_v, lower_v), (0.0, 0.0)
        with self._link.commanding(), self._keyboard.single_keys():
            print("ANY KEY STOPS\r")
            stopped = not (
                self._follow(ramp(zero_v, target_v, self._rate_v_per_s))
                and self._follow(_hold(target_v, hold_s))
                and self._follow(ramp(target_v, zero_v, self._rate_v_per_s))
            )
        print("")
        if stopped:
            print(self._link.trigger("emergency_stop"))

    def _follow(self, voltages_v: Iterator[Voltages]) -> bool:
        """Whether it came to its end without a key or a fault."""
        next_s, shown_s = time.monotonic(), 0.0
        for voltage_v in voltages_v:
            self._link.command(voltage_v)
            state = self._link.state()
            if time.monotonic() - shown_s > SHOW_S:
                shown_s = time.monotonic()
                print(f"\r\x1b[K{describe(state)}", end="", flush=True)
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


def run(namespace: str, usage: str) -> int:
    """Obey what is typed until the end; returns the exit code. `usage`: what can be typed, in words."""
    try:
        link = ConsoleLink(namespace)
    except RCLError as error:  # as without the keys that are asked for
        print(f"console: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    for number in (signal.SIGTERM, signal.SIGHUP):  # as Ctrl-C: nobody is left who could stop
        signal.signal(number, signal.default_int_handler)
    try:
        Console(link, Keyboard(), usage).run()
    except DriverError as error:
        print(error, file=sys.stderr)
        return 1
    finally:
        link.close()
    return 0
