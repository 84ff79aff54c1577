# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_driver virtual_shvps`: a small emulation of one SHVPS board's command set."""

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

from hasel_common.command_entry import command

from hasel_driver.virtual.pseudo_terminal import PseudoTerminal
from hasel_driver.virtual.virtual_output import Contact, VirtualMuscle

LONGEST_COMMAND = 20  # the board's buffer


class VirtualShvps:
    """Answers every command, ended by CR, with one value and CR LF; `Err` where it does not know it."""

    def __init__(self, maximum_v: int = 5000) -> None:
        self.muscle = VirtualMuscle()
        self.values: dict[str, float] = {
            "Vset": 0,
            "Vmax": maximum_v,
            "SwMode": 0,
            "SwSrc": 0,
            "VMode": 0,
            "F": 1,
            "Kp": 0.26,
            "Ki": 1.0,
            "Kd": 0.0003,
        }
        self._pending = ""

    def step(self, duration_s: float) -> None:
        """Advance the output: switched off, the muscle is left to its leakage."""
        on = self.values["SwMode"] != 0
        self.muscle.step(duration_s, Contact.POSITIVE if on else Contact.OPEN, self.values["Vset"])

    def receive(self, data: bytes) -> bytes:
        """The answers to what `data` completes."""
        *commands, self._pending = (self._pending + data.decode("ascii", errors="replace")).split("\r")
        return b"".join(self._answer(command.strip()).encode() + b"\r\n" for command in commands)

    def _answer(self, command: str) -> str:
        if command == "QVer":
            return "slave 5"
        if command == "QVnow":
            return str(round(self.muscle.voltage_v))
        words = command.split()
        name = words[0][1:] if words else ""
        if len(command) > LONGEST_COMMAND or name not in self.values:
            return "Err"
        if command.startswith("S") and len(words) == 2:
            return self._set(name, words[1])
        if command.startswith("Q") and len(words) == 1:
            return f"{self.values[name]:g}"
        return "Err"

    def _set(self, name: str, word: str) -> str:
        try:
            value = float(word)
        except ValueError:
            return "Err"
        if name == "Vset":
            value = min(max(round(value), 0), self.values["Vmax"])
        self.values[name] = value
        return f"{value:g}"


def serve(board: VirtualShvps, port: PseudoTerminal, running: Callable[[], bool]) -> None:
    """Keep `board` going in real time while `running()`."""
    last_s = time.monotonic()
    while running():
        if port.host_present():
            port.write(board.receive(port.read()))
        now_s = time.monotonic()
        board.step(now_s - last_s)
        last_s = now_s
        time.sleep(0.001)


@command
def main() -> None:
    """Command line of the emulation."""
    parser = argparse.ArgumentParser(prog="virtual_shvps", description=__doc__)
    parser.add_argument("--link", type=Path, help="also make the port available under this name")
    parser.add_argument("--maximum-v", type=int, default=5000, help="the board's Vmax [V]")
    arguments = parser.parse_args(sys.argv[1:])
    port = PseudoTerminal(arguments.link)
    print(f"port {port.path}", flush=True)
    try:
        serve(VirtualShvps(arguments.maximum_v), port, lambda: True)
    except KeyboardInterrupt:
        pass
    finally:
        port.unplug()


if __name__ == "__main__":
    sys.exit(main())
