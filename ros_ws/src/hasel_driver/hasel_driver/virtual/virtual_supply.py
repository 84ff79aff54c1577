# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_driver virtual_supply`: the board with supply and muscles, on a pseudo-terminal.

Its standard input takes one fault or question per line (`help` lists them), its standard output tells when
the output goes live and dead (host's monotonic clock [s]) and answers the questions.
"""

import argparse
import os
import random
import re
import select
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path

from hasel_common.command_entry import command
from hasel_common.node_parameter import user_arguments

from hasel_driver.protocol.faults import PortError
from hasel_driver.virtual.pseudo_terminal import PseudoTerminal
from hasel_driver.virtual.virtual_board import ChannelHardware, VirtualBoard
from hasel_driver.virtual.virtual_commands import receive
from hasel_driver.virtual.virtual_output import Contact, VirtualMuscle

LIVE_V = 50.0  # extra-low-voltage bound used in the tests' question "is the output dead?"
LATE_MS, MOST_CATCH_UP_MS = 50, 100
_SET_VOLTAGE = re.compile(rb"SET VOLTAGE (-?\d+) (-?\d+)")
INPUTS = {
    "silence": "send nothing to the host until `recover`",
    "deaf": "hear nothing from the host until `recover`",
    "stuck": "neither hear nor send until `recover`; the timer interrupt still watches",
    "garbage": "send 40 random bytes",
    "truncate": "cut the next line to the host in half",
    "noise": "flip one bit of what the host sends next",
    "reset": "reset the board",
    "lower": "what is injected from now on, until `recover`, breaks the lower muscle's channel, not the upper's",
    "overcurrent": "short the muscle by 2 MΩ until `recover`",
    "interlock": "open both channels of the interlock until `recover`",
    "bounce": "open both channels for 2 ms, as a contact that bounces or a disturbance on its line does",
    "interlock_a": "open its first channel only",
    "interlock_b": "open its second channel only",
    "weld": "weld the muscle's positive contact, so that its ground contact cannot close",
    "unground": "keep the muscle's ground contact from closing",
    "tickless": "switch the board's timer interrupt off, its line goes on",
    "mute_reset": "reset the board, and lose its banner",
    "blind": "take the lead off the muscle's voltage divider",
    "third": "its monitor says a third of what there is",
    "stick": "its monitor says for good what it says now",
    "invert": "its monitor has the wrong sign",
    "unconverted": "the board converts its analogue inputs no more",
    "leak": "the muscle leaks by 100 MΩ",
    "damage": "change a byte of the calibration in the EEPROM; a reset finds it",
    "miscalibrate": "the converter gives 3 % less than asked, its monitor says 4 % more than there is",
    "unplug": "pull the cable",
    "replug": "put it back, under a new path (printed, and linked)",
    "recover": "undo the above but reset and unplug",
    "trace": "print `wire`, the time and the voltages of each SET VOLTAGE from now on",
    "output": "print true voltages [V], ground contacts and highest magnitudes so far [V]",
    "quit": "end",
    "help": "print this list",
}


class VirtualSupply:
    """Board, muscles and port in real time, with injected faults."""

    def __init__(self, board: VirtualBoard, port: PseudoTerminal, tell: Callable[[str], None]) -> None:
        self.board, self.port, self._tell = board, port, tell
        self._faults: set[str] = set()
        self._channel = 0  # that is broken by what is injected
        self._host_present = False
        self._live = self._tracing = False
        self._peaks = [0.0, 0.0]
        self._ticked_s = time.monotonic()
        self.running = True
        tell(f"port {port.path}")

    def inject(self, name: str) -> None:
        """One of INPUTS."""
        board, hardware = self.board, self.board.hardware[self._channel]
        muscle = board.muscles[self._channel]
        match name:
            case "recover":
                self._recover()
            case "help":
                self._tell("\n".join(f"{key:12} {meaning}" for key, meaning in INPUTS.items()))
            case "garbage":
                self.port.write(random.randbytes(40) + b"\n")
            case "reset":
                board.reset("external")  # as opening the port does
            case "mute_reset":
                sent = len(board.transmitted)
                board.reset("external")
                del board.transmitted[sent:]
            case "lower":
                self._channel = 1
            case "overcurrent":
                muscle.short_ohm = 2e6
            case "leak":
                muscle.short_ohm = 1e8
            case "interlock":
                board.interlock_closed = [False, False]
            case "interlock_a":
                board.interlock_closed[0] = False
            case "interlock_b":
                board.interlock_closed[1] = False
            case "bounce":
                board.interlock_closed = [False, False]
                for _ in range(2):
                    board.tick()
                board.interlock_closed = [True, True]
            case "weld":
                hardware.welded = True
            case "unground":
                hardware.ground_broken = True
            case "tickless":
                board.tick_dead = True
            case "unconverted":
                board.unconverted = True
            case "damage":
                board.calibrations_damaged = True
            case "miscalibrate":
                hardware.set_point_gain, hardware.monitor_gain = 0.97, 1.04
            case "blind":
                hardware.monitor_gain = 0.0
            case "third":
                hardware.monitor_gain = 1 / 3
            case "stick":
                hardware.stuck_v = abs(muscle.voltage_v)
            case "invert":
                hardware.inverted = True
            case "unplug":
                self.port.unplug()
            case "replug":
                self.port.unplug()
                self.port.plug()
                self._tell(f"port {self.port.path}")
            case "trace":
                self._tracing = True
            case "output":
                self._tell_output()
            case "quit":
                self.running = False
            case _ if name in INPUTS:
                self._faults.add(name)
            case _:
                self._tell(f"unknown input {name!r}; one of {', '.join(INPUTS)} was expected")

    def _recover(self) -> None:
        self._faults.clear()
        self._channel = 0
        for muscle in self.board.muscles:
            muscle.short_ohm = float("inf")
        self.board.interlock_closed = [True, True]
        self.board.hardware = (ChannelHardware(), ChannelHardware())
        self.board.unconverted = False

    def _tell_output(self) -> None:
        voltages = (f"{muscle.voltage_v:.0f}" for muscle in self.board.muscles)
        contacts = (str(int(closed)) for closed in self._ground_contacts())
        self._tell(" ".join(["output", *voltages, *contacts, *(f"{peak:.0f}" for peak in self._peaks)]))

    def step(self) -> None:
        """Hear, advance to now, send."""
        if self.port.host_present() and not self._host_present:
            self.board.reset("external")  # opening the port toggles DTR
            self.board.transmitted = self.board.transmitted[-200:]
        self._host_present = self.port.host_present()
        self._hear(self.port.read())
        self._advance()
        self._transmit()

    def _hear(self, data: bytes) -> None:
        if len(data) > 3 and "noise" in self._faults:
            self._faults.remove("noise")
            data = data[:-3] + bytes([data[-3] ^ 1]) + data[-2:]
        if self._tracing:
            now_s = time.monotonic()
            for upper, lower in _SET_VOLTAGE.findall(data):
                self._tell(f"wire {now_s:.6f} {upper.decode()} {lower.decode()}")
        if not self._faults & {"deaf", "stuck"}:
            receive(self.board, data)

    def _advance(self) -> None:
        due_ms = int((time.monotonic() - self._ticked_s) * 1e3)
        self._ticked_s += due_ms * 1e-3
        if due_ms > LATE_MS:
            self._tell(f"late {due_ms * 1e-3:.3f}")
        self.board.stand_still(max(due_ms - MOST_CATCH_UP_MS, 0))
        for _ in range(min(due_ms, MOST_CATCH_UP_MS)):
            self.board.tick()
            self._watch_output()

    def _watch_output(self) -> None:
        voltages = [abs(muscle.voltage_v) for muscle in self.board.muscles]
        self._peaks = [max(pair) for pair in zip(self._peaks, voltages, strict=True)]
        live = max(voltages) > LIVE_V or not all(self._ground_contacts())
        if live != self._live:
            self._live = live
            self._tell(f"{'live' if live else 'dead'} {time.monotonic():.4f}")

    def _ground_contacts(self) -> list[bool]:
        return [
            hardware.contact(bridge.contact) is Contact.GROUND
            for hardware, bridge in zip(self.board.hardware, self.board.bridges, strict=True)
        ]

    def _transmit(self) -> None:
        data, self.board.transmitted = bytes(self.board.transmitted), bytearray()
        if "truncate" in self._faults and data:
            self._faults.remove("truncate")
            data = data[: len(data) // 2].rstrip(b"\n")[:-1] + b"\n"  # never between two lines
        if self._host_present and not self._faults & {"silence", "stuck"}:
            self.port.write(data)


def _tell(text: str) -> None:
    print(text, flush=True)


@command
def main() -> None:
    """Command line of the virtual supply."""
    parser = argparse.ArgumentParser(prog="virtual_supply", description=__doc__.splitlines()[0])
    parser.add_argument("--link", type=Path, help="also make the port available under this name")
    parser.add_argument("--capacitance-nf", type=float, default=0.5, help="capacitance of each muscle [nF]")
    arguments = parser.parse_args(user_arguments(sys.argv[1:]))  # launch files add ROS's
    upper, lower = (VirtualMuscle(capacitance_f=arguments.capacitance_nf * 1e-9) for _ in range(2))
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        supply = VirtualSupply(VirtualBoard((upper, lower)), PseudoTerminal(arguments.link), _tell)
    except PortError as error:
        sys.exit(str(error))
    commands = b""
    listening = True
    try:
        while supply.running:
            descriptors = [fd for fd in (supply.port.fileno(), 0 if listening else None) if fd is not None]
            # A port without a host reports a hang-up at once: do not spin on it.
            if not supply.port.host_present():
                descriptors = [fd for fd in descriptors if fd == 0]
            ready, _, _ = select.select(descriptors, [], [], 0.002)
            if 0 in ready:
                data = os.read(0, 4096)
                listening = bool(data)
                *lines, commands = (commands + data).split(b"\n")
                for line in lines:
                    if line.strip():
                        supply.inject(line.decode(errors="replace").strip())
            supply.step()
    except KeyboardInterrupt:
        pass
    finally:
        supply.port.unplug()


if __name__ == "__main__":
    sys.exit(main())
