# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The conversation with a board whose port was just opened: who are you, disarm, these are your limits."""

import time
from collections.abc import Callable
from typing import TypeVar

from hasel_driver.protocol import wire
from hasel_driver.protocol.faults import NEED_PROOF, Fault, FaultCode, PortError, ProtocolError
from hasel_driver.protocol.limits import DISCHARGED_V, MUSCLE_NAMES, Limits
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.protocol.wire import LineBuffer, Telemetry
from hasel_driver.supplies.serial_port import SerialPort

LEAST_CHARGING_UA = 2  # two steps of the monitor: 0.5 nF draw 5 µA at the pulse's 10 V/ms
BOOT_TIMEOUT_S = 2.5  # an Arduino's boot loader takes up to 2 s after the port is opened
RESET_S = 0.3  # a reset at opening has begun by then: telemetry after it comes from a running board
ANSWER_TIMEOUT_S = 1.0
GROUND_TIMEOUT_S = 0.5  # for a muscle that was charged when the port was opened
PROOF_TIMEOUT_S = 1.0  # for the board's test pulse
PING_PERIOD_S = 0.05
KEEPS_FAULT = {"INTERLOCK", "DISCREPANCY", "EEPROM", "MAXIMUM", "UNPROVEN"}
_Message = TypeVar("_Message", wire.Reply, wire.Event, wire.Telemetry)


class PulseSight:
    """What was seen of a test pulse, so that one that proves nothing says where it saw no load.

    Takes the reports from the begin of the pulse on; the highest magnitudes of each channel count.
    """

    def __init__(self) -> None:
        self._most: list[tuple[int, int]] | None = None  # V and µA, of each channel

    def take(self, report: Telemetry) -> None:
        """One report; those that are not of the pulse are left out."""
        if report.mode is Mode.ACTIVE:
            before = self._most or [(0, 0)] * len(MUSCLE_NAMES)
            now = zip(map(abs, report.measured), report.current, strict=True)
            self._most = [(max(v, w), max(i, j)) for (v, i), (w, j) in zip(before, now, strict=True)]

    def without_load(self, measured_v: tuple[int, int]) -> str:
        """Where no load was seen, in words; nothing for a channel on which there is voltage `measured_v` still."""
        if self._most is None:
            return ""
        found = [
            f"{name} at most {most_v} V and {most_ua} µA"
            for name, still_v, (most_v, most_ua) in zip(MUSCLE_NAMES, measured_v, self._most, strict=True)
            if most_ua < LEAST_CHARGING_UA and abs(still_v) < DISCHARGED_V
        ]
        where = ", ".join(found)
        return where and f"the test pulse saw no load ({where}): look for a muscle that is not connected"


class BoardHandshake:
    """Waits for each answer, so it is for use before anything is armed only."""

    def __init__(self, port: SerialPort, lines: LineBuffer, clock: Callable[[], float]) -> None:
        self._port, self._lines, self._clock = port, lines, clock
        self._sequence = 0
        self.pulse: PulseSight | None = None  # what was seen of the last test pulse

    def perform(self, limits: Limits, prove: bool = False) -> tuple[str, Fault | None]:
        """The board's name, and the fault it had kept; afterwards it is disarmed, with `limits` applied.

        It is in STANDBY, or still in FAULT where it may not forget one: an open interlock, a charged output, a ground
        contact that its test pulse did not find closed. With `prove`, that pulse is made whatever the fault; without it
        a fault that only the pulse takes away stays: who opens a port may have his hands at the contacts.

        Raises:
            PortError: no board, another program on it, or a limit it does not accept.
            SupplyFaultError: the port went away meanwhile.
        """
        self._await_boot()
        name = " ".join(self.transact("GET", "IDENTITY")[1:])
        if name.split()[2:] != ["protocol", str(wire.PROTOCOL_VERSION)]:
            raise PortError(
                f"{name!r} answers on {self._port.path}, protocol {wire.PROTOCOL_VERSION} was expected:"
                " load the sketch in firmware/ onto the board."
            )
        self.transact("DISARM")
        fault = self._inherited_fault()
        self._apply(limits)
        if fault is not None and (prove or fault.code not in NEED_PROOF) and self._clear():
            self._await_proof()
        if prove and self._report().ground is Ground.COMMANDED and self._ask("ARM").accepted:
            self._await_proof()
            self.transact("DISARM")
        return name, fault

    def _await_boot(self) -> None:
        """Until the banner of a board that resets when its port is opened, or proof that this one did not."""
        opened_s = self._clock()
        while self._clock() < opened_s + BOOT_TIMEOUT_S:
            for message in self._messages():
                booted = isinstance(message, wire.Event) and message.words[0] == "BOOT"
                running = isinstance(message, wire.Telemetry) and self._clock() > opened_s + RESET_S
                if booted or running:
                    return

    def _clear(self) -> bool:
        deadline_s = self._clock() + GROUND_TIMEOUT_S
        while True:
            reply = self._ask("CLEAR")
            if reply.accepted:
                return True
            if reply.words[0] == "STATE" or reply.words[0] in KEEPS_FAULT - {"UNPROVEN"}:
                return False
            if reply.words[0] not in KEEPS_FAULT:
                raise self._refused(reply, "CLEAR")
            if self._clock() > deadline_s:
                return False

    def _await_proof(self) -> None:
        """Until the board's test pulse has ended, one way or the other."""
        self.pulse = PulseSight()
        deadline_s = self._clock() + PROOF_TIMEOUT_S
        while self._report().mode is Mode.ACTIVE and self._clock() < deadline_s:
            self.transact("PING")
            time.sleep(PING_PERIOD_S)

    def _report(self) -> wire.Telemetry:
        """One that was made after the last answer."""
        self._messages()
        self._await(wire.Telemetry, lambda message: True, "telemetry")
        return self._await(wire.Telemetry, lambda message: True, "telemetry")

    def _inherited_fault(self) -> Fault | None:
        report = self._report()
        return Fault(board_fault(report.fault_code)) if report.mode is Mode.FAULT else None

    def _apply(self, limits: Limits) -> None:
        for quantity, value in (
            ("MAXIMUM", limits.maximum_voltage_v),
            ("SLEW", limits.slew_v_per_ms),
            ("TRIP", limits.trip_current_a * 1e6),
            ("HEARTBEAT", limits.heartbeat_s * 1e3),
            ("DEADTIME", limits.dead_time_s * 1e3),
            ("CONTACTS", limits.contacts_read),
        ):
            applied = self.transact("SET", quantity, round(value))
            if applied != (quantity, str(round(value))):
                raise PortError(
                    f"The board applied {' '.join(applied)}, {round(value)} was asked for:"
                    " choose a limit within the range in firmware/PROTOCOL.md."
                )

    def transact(self, *words: object) -> tuple[str, ...]:
        reply = self._ask(*words)
        if not reply.accepted:
            raise self._refused(reply, " ".join(str(word) for word in words))
        return reply.words

    def _ask(self, *words: object) -> wire.Reply:
        self._sequence = (self._sequence + 1) % wire.SEQUENCE_MODULUS
        self._port.write(wire.encode_command(self._sequence, *words))
        return self._await(
            wire.Reply,
            lambda reply: reply.sequence == self._sequence,
            f"answer to {' '.join(str(word) for word in words)}",
        )

    def _refused(self, reply: wire.Reply, text: str) -> PortError:
        return PortError(
            f"The board on {self._port.path} answered {' '.join(reply.words)} to {text}: reset it and try again."
        )

    def _await(self, kind: type[_Message], wanted: Callable[[_Message], bool], what: str) -> _Message:
        deadline_s = self._clock() + ANSWER_TIMEOUT_S
        while self._clock() < deadline_s:
            for message in self._messages():
                if isinstance(message, kind) and wanted(message):
                    return message
        raise PortError(
            f"The device on {self._port.path} sent no {what} within {ANSWER_TIMEOUT_S} s: check that it is"
            f" the supply, that it is powered, and that it runs the sketch in firmware/ ({wire.BAUD} baud,"
            f" protocol {wire.PROTOCOL_VERSION})."
        )

    def _messages(self) -> list[wire.Line]:
        messages = []
        for line in self._lines.feed(self._port.read()):
            try:
                message = wire.parse_device_line(line)
            except ProtocolError:
                continue  # a boot loader, or a line that began before we listened
            messages.append(message)
            if self.pulse is not None and isinstance(message, wire.Telemetry):
                self.pulse.take(message)
        time.sleep(0.002)
        return messages


def board_fault(code: int) -> FaultCode:
    """The board's fault code in words; one that this driver does not know is UNEXPECTED_STATE."""
    return FaultCode(code) if code in FaultCode.__members__.values() else FaultCode.UNEXPECTED_STATE
