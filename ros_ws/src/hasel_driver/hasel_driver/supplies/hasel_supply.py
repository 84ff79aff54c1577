# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The supply that speaks `firmware/PROTOCOL.md`."""

import math
import time
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from hasel_driver.protocol import wire
from hasel_driver.protocol.faults import (
    NEED_PROOF,
    Fault,
    FaultCode,
    PortError,
    ProtocolError,
    SupplyFaultError,
)
from hasel_driver.protocol.limits import DISCHARGED_V, LEAST_PULSE_V, Limits, Voltages
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.protocol.waveform import Waveform
from hasel_driver.protocol.wire import LineBuffer
from hasel_driver.supplies.board_handshake import BoardHandshake, PulseSight, board_fault
from hasel_driver.supplies.serial_port import SerialPort
from hasel_driver.supplies.supply import Capabilities, Connection, Reading, Supply

_WRAP_US = 2**32
REPLY_TIMEOUT_S = 0.2
HEARTBEAT_PERIOD_S = 0.05
CLOCK_MODULUS_US = 2**32
REFUSALS = {
    "INTERLOCK": "its interlock is open",
    "DISCREPANCY": "one channel of its interlock opened without the other: open both, and close them",
    "UNPROVEN": "its output is not grounded",
    "EEPROM": "the calibration in its EEPROM is damaged: store it again, with `calibrate`",
    "MAXIMUM": f"maximum_voltage is below {LEAST_PULSE_V:g} V, too little for the pulse that proves its ground",
}
MOST_UNANSWERED = 2  # two commands fit into the board's receive buffer


class DeviceClock:
    """Maps the board's microseconds to host seconds.

    A line can only arrive late, never early, so the least (arrival − device time) of the last `window_s`
    seconds is the best offset; the window lets it follow the drift of the board's resonator.
    """

    def __init__(self, window_s: float = 10.0) -> None:
        self._window_s = window_s
        self._offsets: deque[tuple[float, float]] = deque()  # (arrival, offset), offsets increasing
        self._last_us: int | None = None
        self._wraps = 0
        self._last_s = -math.inf

    def host_time(self, device_us: int, arrival_s: float) -> float:
        """Host time [s] at which the board's clock showed `device_us`; increasing, at most `arrival_s`."""
        if self._last_us is not None and device_us < self._last_us - _WRAP_US // 2:
            self._wraps += 1
        self._last_us = device_us
        device_s = (device_us + self._wraps * _WRAP_US) * 1e-6
        offset = arrival_s - device_s
        while self._offsets and self._offsets[-1][1] >= offset:
            self._offsets.pop()
        self._offsets.append((arrival_s, offset))
        while self._offsets[0][0] < arrival_s - self._window_s:
            self._offsets.popleft()
        # A better offset moves time back: do not let two reports change order.
        self._last_s = min(max(device_s + self._offsets[0][1], self._last_s + 1e-6), arrival_s)
        return self._last_s


@dataclass(frozen=True)
class _Pending:
    words: tuple[str, ...]
    deadline_s: float


class HaselSupply(Supply):
    """Two bipolar channels behind one Arduino."""

    capabilities = Capabilities(deadman=True, proves_grounded=True, bipolar=True, waveforms=True)

    def __init__(self, port: SerialPort, limits: Limits, clock: Callable[[], float] = time.monotonic) -> None:
        super().__init__(limits)
        self._port, self._clock = port, clock
        self._forget_link()

    def _forget_link(self) -> None:
        self._lines = LineBuffer()
        self._device_clock = DeviceClock()
        self._pending: dict[int, _Pending] = {}
        self._sequence = 0
        self._sent_s = 0.0
        self._wanted: Voltages | None = None  # voltage waiting for room on the line
        self._reset_found = False
        self._pulse: PulseSight | None = None  # since it began, until it has proven the ground
        self._device_us: int | None = None  # the board's clock in its last report
        self._maxima_v = {round(self.limits.maximum_voltage_v)}  # that the board may report

    def open(self, prove: bool = False) -> Connection:
        self._forget_link()
        self._port.open()
        handshake = BoardHandshake(self._port, self._lines, self._clock)
        try:
            name, fault = handshake.perform(self.limits, prove)
        except SupplyFaultError as problem:
            self._port.close()
            raise PortError(
                f"The board on {self._port.path} failed while it was opened: {problem}."
            ) from problem
        except PortError:
            self._port.close()
            raise
        self._pulse = handshake.pulse
        return Connection(name, fault)

    def close(self) -> None:
        if self._port.fileno() is not None:
            with suppress(SupplyFaultError):  # a port that is gone: the board's heartbeat timeout grounds it
                self.disarm()
        self._port.close()

    def descriptors(self) -> list[int]:
        descriptor = self._port.fileno()
        return [] if descriptor is None else [descriptor]

    def service(self, now_s: float, heartbeat: bool) -> list[Reading]:
        readings = []
        for line in self._lines.feed(self._port.read()):
            reading = self._take(line, now_s)
            if reading is not None:
                readings.append(reading)
        overdue = [pending for pending in self._pending.values() if pending.deadline_s < now_s]
        if overdue:
            self._pending.clear()
            raise SupplyFaultError(FaultCode.NO_REPLY, " ".join(overdue[0].words))
        self._send_due(now_s, heartbeat)
        return readings

    def arm(self) -> None:
        self.refusal = None
        self._send("ARM")

    def disarm(self) -> None:
        self._send("DISARM")

    def stop(self) -> None:
        self._send("STOP")

    def set_voltage(self, voltage_v: Voltages) -> None:
        if len(self._pending) < MOST_UNANSWERED:
            self._send("SET", "VOLTAGE", *(round(value) for value in voltage_v))
        else:
            self._wanted = voltage_v

    def ground(self) -> None:
        self._send("GROUND")

    def lower_maximum(self, voltage_v: float) -> None:
        super().lower_maximum(voltage_v)
        self._maxima_v.add(round(voltage_v))  # the former one may still be on the line
        self._send("SET", "MAXIMUM", round(voltage_v))

    def start(self, waveform: Waveform) -> None:
        numbers = (waveform.voltage_v, waveform.frequency_hz * 1e3, waveform.periods, waveform.duty * 1e3)
        integers = [round(number) for number in numbers]
        self._send("SET", "WAVEFORM", waveform.shape, *integers, waveform.polarity, waveform.muscles)
        self._send("START")

    def _send(self, *words: object) -> None:
        self._wanted = None  # any later command makes a voltage that still waits obsolete
        self._sequence = (self._sequence + 1) % wire.SEQUENCE_MODULUS
        self._port.write(wire.encode_command(self._sequence, *words))
        self._sent_s = self._clock()
        texts = tuple(str(word) for word in words)
        self._pending[self._sequence] = _Pending(texts, self._sent_s + REPLY_TIMEOUT_S)

    def _send_due(self, now_s: float, heartbeat: bool) -> None:
        if len(self._pending) >= MOST_UNANSWERED:
            return
        if self._wanted is not None:
            self.set_voltage(self._wanted)
        elif heartbeat and now_s - self._sent_s >= HEARTBEAT_PERIOD_S:
            self._send("PING")

    def _take(self, line: bytes, now_s: float) -> Reading | None:
        try:
            message = wire.parse_device_line(line)
        except ProtocolError as error:
            raise SupplyFaultError(FaultCode.GARBAGE_RECEIVED, str(error)) from error
        if isinstance(message, wire.Telemetry):
            return self._read(message, now_s)
        if isinstance(message, wire.Reply):
            self._take_reply(message)
        elif message.words[0] == "BOOT":
            self._reset_found = True
            raise SupplyFaultError(FaultCode.DEVICE_RESET, " ".join(message.words[1:]))
        return None

    def _take_reply(self, reply: wire.Reply) -> None:
        text = " ".join(reply.words)
        if reply.sequence is None:
            raise SupplyFaultError(FaultCode.GARBAGE, f"the board answered {text}")
        pending = self._pending.pop(reply.sequence, None)
        if not reply.accepted and reply.words[0] == "SEQUENCE":
            raise SupplyFaultError(FaultCode.SEQUENCE, f"the board answered {text}")
        if pending is None or not _answers(reply, pending.words):
            raise SupplyFaultError(
                FaultCode.TWO_MASTERS, f"the board answered {text}, which was not asked here"
            )
        if reply.accepted:
            if reply.words[0] == "MAXIMUM":
                self._maxima_v = {round(self.limits.maximum_voltage_v)}
            elif reply.words[0] == "ARM":
                self._pulse = PulseSight()
            return
        if pending.words[0] == "ARM":
            self.refusal = REFUSALS.get(reply.words[0], f"the board answered {text}")
        elif reply.words[0] != "STATE":  # a voltage may cross a fault on the line; telemetry tells that fault
            raise SupplyFaultError(FaultCode.COMMAND_REFUSED, text)

    def _read(self, report: wire.Telemetry, now_s: float) -> Reading:
        self._check_for_reset(report)
        if report.mode in (Mode.STANDBY, Mode.ARMED):
            self._pulse = None
        elif self._pulse is not None:
            self._pulse.take(report)
        fault = self._fault(report) if report.mode is Mode.FAULT else None
        discharged = all(abs(volts) < DISCHARGED_V for volts in report.measured)
        return Reading(
            time_s=self._device_clock.host_time(report.time_us, now_s),
            mode=report.mode,
            ground=report.ground if discharged else Ground.NOT,
            fault=fault,
            commanded_v=(float(report.voltage[0]), float(report.voltage[1])),
            measured_v=(float(report.measured[0]), float(report.measured[1])),
            current_a=(report.current[0] * 1e-6, report.current[1] * 1e-6),
            interlock_closed=report.interlock,
        )

    def _check_for_reset(self, report: wire.Telemetry) -> None:
        last_us, self._device_us = self._device_us, report.time_us
        if last_us is not None and (report.time_us - last_us) % CLOCK_MODULUS_US > CLOCK_MODULUS_US // 2:
            self._reset_found = True
            raise SupplyFaultError(
                FaultCode.DEVICE_RESET, "its clock went back, though it did not announce a reset"
            )
        if report.maximum not in self._maxima_v and not self._reset_found:
            self._reset_found = True  # once: its further reports still tell the truth about its output
            expected = " or ".join(f"{volts} V" for volts in sorted(self._maxima_v))
            raise SupplyFaultError(
                FaultCode.DEVICE_RESET, f"its maximum is {report.maximum} V, {expected} was expected"
            )

    def _fault(self, report: wire.Telemetry) -> Fault:
        code, limits = board_fault(report.fault_code), self.limits
        if code is FaultCode.OVERCURRENT:
            slew, trip_ua = limits.slew_v_per_ms, limits.trip_current_a * 1e6
            return Fault(
                code,
                f"charging at slew_rate {1e3 * slew:g} V/s takes {slew:g} µA for each nF, so {trip_ua / slew:.2g} nF"
                f" reach the {trip_ua:g} µA of trip_current; lower slew_rate for more, else look for a breakdown",
            )
        if code is FaultCode.INTERLOCK:
            words = ("closed" if closed else "open" for closed in report.interlock)
            return Fault(code, "its two channels are now " + " and ".join(words))
        measured = (
            f"{report.measured[0]} and {report.measured[1]} V" if code is FaultCode.NOT_GROUNDED else ""
        )
        pulse = ""
        if self._pulse is not None and code in NEED_PROOF:
            pulse = self._pulse.without_load(report.measured)
        return Fault(code, "; ".join(filter(None, (measured, pulse))))


def _answers(reply: wire.Reply, command: tuple[str, ...]) -> bool:
    """Whether `reply` speaks of `command`, and not of one that another master numbered alike."""
    if not reply.accepted:
        return reply.words[1:] == command
    return reply.words[0] == (command[1] if command[0] == "SET" else command[0])
