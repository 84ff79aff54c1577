# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The supply's board in Python: the same protocol, states and faults as the sketch in `firmware/`."""

import math
from dataclasses import dataclass, replace
from enum import Enum, auto

from hasel_driver.protocol import wire
from hasel_driver.protocol.calibration import Calibration
from hasel_driver.protocol.faults import FaultCode
from hasel_driver.protocol.limits import DISCHARGED_V, LEAST_PULSE_V, PULSE_V
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.protocol.waveform import Waveform
from hasel_driver.protocol.wire import LineBuffer
from hasel_driver.safety.supply_checks import MonitorWatch
from hasel_driver.virtual.virtual_output import (
    GROUND_PROOF_MS,
    LEAK_MS,
    LEAST_FALL_V,
    Contact,
    GroundEvidence,
    GroundProof,
    GroundVerdict,
    VirtualBridge,
    VirtualMuscle,
)

CONFIRMATION_MS = 3  # a trip must hold this long
PULSE_SLEW_V = 10  # per millisecond
STALE_MS, BLIND_MS = 3, 100  # inputs not converted for so long tell nothing; are a fault
DISCREPANCY_MS = 500  # the interlock's channels may differ that long
WATCHDOG_MS = 250
MONITOR_V, MONITOR_A = 10_000.0, 1e-3  # ends of the monitors' ranges
MONITOR_STEPS = 1023
# quantity: (least, most, at boot)
SETTINGS: dict[str, tuple[int, int, int]] = {
    "MAXIMUM": (0, 9_800, 0),
    "SLEW": (1, 2_000, 250),
    "TRIP": (1, 980, 450),
    "HEARTBEAT": (100, 2_000, 500),
    "DEADTIME": (2, 50, 5),
    "CONTACTS": (0, 1, 0),
    "TELEMETRY": (10, 1_000, 10),
}


class Latch(Enum):
    """What outlives a reset, in the EEPROM: a fault that only its proof, or the interlock seen open, takes away."""

    UNPROVEN = auto()
    DISAGREED = auto()


@dataclass
class ChannelHardware:
    """What the board does not know of one channel's relays, converter and monitor."""

    welded: bool = False  # the positive contact stays closed, and keeps the ground contact open
    ground_broken: bool = False  # the ground contact does not close
    set_point_gain: float = 1.0
    monitor_gain: float = 1.0
    stuck_v: float | None = None  # what the monitor says for good
    inverted: bool = False  # the monitor's sign

    def contact(self, asked: Contact) -> Contact:
        """The contact that is closed when the board closes `asked`."""
        if self.welded:
            return Contact.POSITIVE
        return Contact.OPEN if self.ground_broken and asked is Contact.GROUND else asked

    def monitor_v(self, voltage_v: float) -> float:
        """Magnitude that the monitor gives [V]."""
        return (
            self.stuck_v if self.stuck_v is not None else min(abs(voltage_v) * self.monitor_gain, MONITOR_V)
        )


class VirtualBoard:
    """Commanded by `virtual_commands.receive`, advanced by the millisecond; collects its output in `transmitted`."""

    def __init__(self, muscles: tuple[VirtualMuscle, VirtualMuscle] | None = None) -> None:
        self.muscles = muscles or (VirtualMuscle(), VirtualMuscle())
        self.interlock_closed = [True, True]
        self.calibrations = [Calibration(), Calibration()]
        self.calibrations_damaged = False
        self.latches: set[Latch] = set()
        self.hardware = (ChannelHardware(), ChannelHardware())  # upper muscle first
        self.unconverted = False  # the converter of the analogue inputs has stopped
        self.transmitted = bytearray()
        self.reset("power")

    def reset(self, cause: str) -> None:
        """Boot: grounded, disarmed, every setting at its default; the muscles keep their charge."""
        self.bridges = (VirtualBridge(), VirtualBridge())
        self.mode, self.fault = Mode.STANDBY, FaultCode.NONE
        self.settings = {name: initial for name, (_, _, initial) in SETTINGS.items()}
        self.voltage = self.wanted = (0, 0)
        self.waveform = Waveform("box", 0, 1.0, 1)
        self.waveform_ms: int | None = None
        self.tick_dead = self.unconverted = False
        self.proof: GroundProof | None = None
        self.evidence = (GroundEvidence(), GroundEvidence())
        self.monitors = (MonitorWatch(), MonitorWatch())
        self._stale_ms = STALE_MS
        # What the monitors said last, corrected [V]; their sign is that of the polarity contacts.
        self.measured_v: tuple[float, float] = (0.0, 0.0)
        self._time_ms = self.heartbeat_ms = self._telemetry_ms = self._unfed_ms = self._discrepancy_ms = 0
        self._charged_ms = [0, 0]
        self._over_ms = dict.fromkeys((FaultCode.INTERLOCK, FaultCode.OVERCURRENT, FaultCode.OVERVOLTAGE), 0)
        self.sequence = 0  # of the last command
        self.lines = LineBuffer()
        self.send("!BOOT " + " ".join(wire.IDENTITY) + f" reset={cause}")
        for latch, code in (
            (Latch.UNPROVEN, FaultCode.NOT_GROUNDED),
            (Latch.DISAGREED, FaultCode.DISCREPANCY),
        ):
            if latch in self.latches:
                self.fail(code)
        if self.calibrations_damaged:
            self.fail(FaultCode.EEPROM)

    @property
    def grounded(self) -> bool:
        """Whether both ground contacts should be closed, and both muscles measure as discharged."""
        discharged = all(abs(volts) < DISCHARGED_V for volts in self.measured_v)
        return self._stale_ms < STALE_MS and discharged and self._contacts_grounded

    @property
    def ground(self) -> Ground:
        """What is known of the output."""
        if not self.grounded:
            return Ground.NOT
        proven = self.settings["CONTACTS"] or all(each.proven for each in self.evidence)
        return Ground.PROVEN if proven and Latch.UNPROVEN not in self.latches else Ground.COMMANDED

    @property
    def _contacts_grounded(self) -> bool:
        return all(map(self._closed, range(2)))

    def _closed(self, channel: int) -> bool:
        """The ground contact by what was commanded, and by its auxiliary contact where that is wired."""
        commanded = self.bridges[channel].contact
        read = self.hardware[channel].contact(commanded) if self.settings["CONTACTS"] else commanded
        return self.bridges[channel].grounded and read is Contact.GROUND

    def _convert(self) -> None:
        upper, lower = (
            math.copysign(
                calibration.measured_v(hardware.monitor_v(muscle.voltage_v)),
                -muscle.voltage_v if hardware.inverted else muscle.voltage_v,
            )
            for calibration, hardware, muscle in zip(
                self.calibrations, self.hardware, self.muscles, strict=True
            )
        )
        self.measured_v = (upper, lower)

    def tick(self) -> None:
        """One millisecond of board and muscles."""
        self._unfed_ms += 1
        if not self.unconverted:
            self._convert()
            self._unfed_ms = self._unfed_ms if self.tick_dead else 0
        if self._unfed_ms >= WATCHDOG_MS:
            self.reset("watchdog")
        elif not self.tick_dead:
            self._control()
        for channel, (bridge, muscle) in enumerate(zip(self.bridges, self.muscles, strict=True)):
            set_point_v = min(self.calibrations[channel].set_point_v(bridge.set_point_v), MONITOR_V)
            contact = self.hardware[channel].contact(bridge.contact)
            muscle.step(1e-3, contact, set_point_v * self.hardware[channel].set_point_gain)
        self._telemetry_ms += 1
        if self._telemetry_ms >= self.settings["TELEMETRY"]:
            self._telemetry_ms = 0
            self._report()

    def stand_still(self, duration_ms: int) -> None:
        """Let the clock go on, and nothing else: this machine was late, which a board of its own is not."""
        self._time_ms += duration_ms

    def _control(self) -> None:
        self._time_ms += 1
        self.heartbeat_ms += 1
        self._stale_ms = self._stale_ms + 1 if self.unconverted else 0
        if self._stale_ms >= BLIND_MS:
            self.fail(FaultCode.MONITOR)
        self._watch_interlock()
        self._watch_ground()
        if self.mode.may_be_live:
            self._watch()
        if self.proof is not None:
            self._prove(self.proof)
        self.wanted = self._wanted() if self.mode.may_be_live else (0, 0)
        self._move()

    def _move(self) -> None:
        slew_v, dead_time_ms, least_v = self.settings["SLEW"], self.settings["DEADTIME"], LEAST_FALL_V
        wanted: tuple[float, float] = self.wanted
        if self.proof is not None:
            slew_v, dead_time_ms, least_v = PULSE_SLEW_V, max(dead_time_ms, LEAK_MS), LEAST_PULSE_V / 2
            wanted = (min(self.proof.wanted_v, self.settings["MAXIMUM"]),) * 2
        for channel, (bridge, measured) in enumerate(zip(self.bridges, self.measured_v, strict=True)):
            bridge.step(wanted[channel], slew_v, measured, dead_time_ms)
            self.evidence[channel].step(self._closed(channel), abs(measured), least_v)

    def begin_proof(self) -> None:
        """The test pulse, after which the board is ARMED, or in STANDBY where a fault was to be cleared."""
        self.proof = GroundProof(min(PULSE_V, self.settings["MAXIMUM"]))
        self.monitors = (MonitorWatch(), MonitorWatch())
        self.mode = Mode.ACTIVE

    def _prove(self, proof: GroundProof) -> None:
        magnitudes = [abs(volts) for volts in self.measured_v]
        verdict = proof.step(magnitudes, self._contacts_grounded, self.evidence)
        if verdict is GroundVerdict.NOT_CHARGED and Latch.UNPROVEN not in self.latches:
            self.fail(FaultCode.MONITOR)
        elif verdict in (GroundVerdict.NOT_CHARGED, GroundVerdict.NOT_GROUNDED):
            self.fail(FaultCode.NOT_GROUNDED)
        elif verdict is GroundVerdict.PROVEN:
            self.proof = None
            self.mode = Mode.ARMED if self.fault is FaultCode.NONE else Mode.STANDBY
            self.fault = FaultCode.NONE
            self.latches.discard(Latch.UNPROVEN)
        elif not proof.wanted_v:
            for bridge in self.bridges:
                bridge.release()

    def _watch_interlock(self) -> None:
        if not any(self.interlock_closed):
            self.latches.discard(Latch.DISAGREED)
        self._discrepancy_ms = self._discrepancy_ms + 1 if len(set(self.interlock_closed)) > 1 else 0
        if self._discrepancy_ms > DISCREPANCY_MS:
            self.latches.add(Latch.DISAGREED)
            self.fail(FaultCode.DISCREPANCY)

    def _watch_ground(self) -> None:
        for channel, (bridge, volts) in enumerate(zip(self.bridges, self.measured_v, strict=True)):
            charged = bridge.grounded and (abs(volts) >= DISCHARGED_V or not self._closed(channel))
            self._charged_ms[channel] = self._charged_ms[channel] + 1 if charged else 0
            if self._charged_ms[channel] >= GROUND_PROOF_MS:
                self.fail(FaultCode.NOT_GROUNDED)

    def _watch(self) -> None:
        if self.heartbeat_ms > self.settings["HEARTBEAT"]:
            self.fail(FaultCode.HEARTBEAT)
        # A monitor at the end of its range cannot tell how much there is: that too is more than allowed.
        last = (MONITOR_STEPS - 1) / MONITOR_STEPS
        most_v = max(self.settings["MAXIMUM"] * 1.05, self.settings["MAXIMUM"] + 100)
        most_a = min(self.settings["TRIP"] * 1e-6, last * MONITOR_A)
        sources = [
            (abs(volts), abs(self.hardware[channel].monitor_v(muscle.voltage_v)))
            for channel, (volts, muscle) in enumerate(zip(self.measured_v, self.muscles, strict=True))
            if self.bridges[channel].contact.sign
        ]
        over = {
            FaultCode.INTERLOCK: not all(self.interlock_closed),
            FaultCode.OVERCURRENT: any(m.current_a > most_a for m in self.muscles),
            FaultCode.OVERVOLTAGE: any(v > most_v or monitor > last * MONITOR_V for v, monitor in sources),
        }
        for code, exceeded in over.items():
            self._over_ms[code] = self._over_ms[code] + 1 if exceeded else 0
            if self._over_ms[code] >= CONFIRMATION_MS:
                self.fail(code)
        for bridge, monitor, volts in zip(self.bridges, self.monitors, self.measured_v, strict=True):
            sign = bridge.contact.sign
            if sign and monitor.step(bridge.set_point_v, bridge.set_point_v, abs(volts), 1e-3):
                self.fail(FaultCode.MONITOR)

    def _wanted(self) -> tuple[int, int]:
        if self.waveform_ms is None:
            return self.voltage
        time_s = self.waveform_ms * 1e-3
        self.waveform_ms += 1
        if time_s >= self.waveform.duration_s:
            self.set_voltage((0, 0))
            self.send("!WAVEFORM DONE")
            return 0, 0
        upper, lower = (self._clip(round(value)) for value in self.waveform.voltage(time_s))
        return upper, lower

    def _clip(self, voltage: int) -> int:
        most = self.settings["MAXIMUM"]
        return min(max(voltage, -most), most)

    def lower_maximum(self) -> None:
        """Clip what is asked for to MAXIMUM; the converter cannot sink, so what is above it goes by way of ground."""
        most = self.settings["MAXIMUM"]
        upper, lower = (self._clip(value) for value in self.voltage)
        self.voltage = (upper, lower)
        self.waveform = replace(self.waveform, voltage_v=min(self.waveform.voltage_v, most))
        for bridge in self.bridges:
            if bridge.set_point_v > most:
                bridge.release()

    def _report(self) -> None:
        upper, lower = self.muscles
        measured = [round(volts) for volts in self.measured_v]
        falling = self.mode is Mode.ARMED and not self._contacts_grounded
        report = wire.Telemetry(
            time_us=self._time_ms * 1000,
            mode=Mode.ACTIVE if falling else self.mode,
            ground=self.ground,
            fault_code=self.fault,
            voltage=self.wanted if self.mode.may_be_live else (0, 0),
            measured=(measured[0], measured[1]),
            current=(round(upper.current_a * 1e6), round(lower.current_a * 1e6)),
            interlock=(self.interlock_closed[0], self.interlock_closed[1]),
            maximum=self.settings["MAXIMUM"],
        )
        self.transmitted += wire.encode_telemetry(report)

    def send(self, text: str) -> None:
        self.transmitted += wire.encode(text)

    def release(self, mode: Mode) -> None:
        """Converters off, contacts on their way to ground."""
        self.mode, self.voltage, self.waveform_ms, self.proof = mode, (0, 0), None, None
        for bridge in self.bridges:
            bridge.release()

    def fail(self, code: FaultCode) -> None:
        """Ground and latch the first fault."""
        self.release(Mode.FAULT)
        if code is FaultCode.NOT_GROUNDED:
            self.latches.add(Latch.UNPROVEN)
        if self.fault is FaultCode.NONE:
            self.fault = code
            self.send(f"!FAULT {int(code)} {code.name}")

    def set_voltage(self, voltage: tuple[int, int]) -> None:
        """Ask for a voltage [V], within MAXIMUM; ends a waveform."""
        self.voltage, self.waveform_ms = voltage, None
        self.mode = Mode.ACTIVE if any(voltage) else Mode.ARMED
