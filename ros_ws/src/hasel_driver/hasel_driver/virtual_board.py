"""The supply's board in Python: the same protocol, states and faults as the sketch in `firmware/`."""

import math
from dataclasses import dataclass, field, replace

from hasel_driver import protocol
from hasel_driver.calibration import Calibration
from hasel_driver.errors import ProtocolError
from hasel_driver.faults import FaultCode
from hasel_driver.limits import DISCHARGED_V
from hasel_driver.line_buffer import LineBuffer
from hasel_driver.mode import Mode
from hasel_driver.virtual_bridge import VirtualBridge
from hasel_driver.virtual_commands import SETTINGS, RefusalError, execute
from hasel_driver.virtual_muscle import Contact, VirtualMuscle
from hasel_driver.waveform import Waveform

CONFIRMATION_MS = 3  # a trip must hold this long
GROUND_PROOF_MS = 100  # a closed ground contact must have discharged its muscle by then
DISCREPANCY_MS = 500  # the interlock's channels may differ that long
WATCHDOG_MS = 250
MONITOR_V, MONITOR_A = 10_000.0, 1e-3  # ends of the monitors' ranges
MONITOR_STEPS = 1023


@dataclass
class Hardware:
    """What the board does not know of its relays, converters and monitors; upper muscle first."""

    welded: bool = (
        False  # the upper muscle's positive contact stays closed, and keeps the ground contact open
    )
    ground_broken: bool = False  # the upper muscle's ground contact does not close
    set_point_gain: list[float] = field(default_factory=lambda: [1.0, 1.0])
    monitor_gain: list[float] = field(default_factory=lambda: [1.0, 1.0])

    def contact(self, channel: int, asked: Contact) -> Contact:
        """The contact that is closed when the board closes `asked`."""
        if channel == 0 and self.welded:
            return Contact.POSITIVE
        if channel == 0 and self.ground_broken and asked is Contact.GROUND:
            return Contact.OPEN
        return asked

    def monitor_v(self, channel: int, voltage_v: float) -> float:
        """Magnitude that a muscle's monitor gives [V]."""
        return min(abs(voltage_v) * self.monitor_gain[channel], MONITOR_V)


class VirtualBoard:
    """Reads command bytes, is advanced by the millisecond, and collects its output in `transmitted`."""

    def __init__(self, muscles: tuple[VirtualMuscle, VirtualMuscle] | None = None) -> None:
        self.muscles = muscles or (VirtualMuscle(), VirtualMuscle())
        self.interlock_closed = [True, True]
        self.calibrations = [Calibration(), Calibration()]
        self.hardware = Hardware()
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
        self.discrepancy = self.tick_dead = False
        self._time_ms = self._heartbeat_ms = self._telemetry_ms = self._unfed_ms = self._discrepancy_ms = 0
        self._charged_ms = [0, 0]
        self._over_ms = {FaultCode.OVERCURRENT: 0, FaultCode.OVERVOLTAGE: 0}
        self._sequence = 0
        self._lines = LineBuffer()
        self._send("!BOOT " + " ".join(protocol.IDENTITY) + f" reset={cause}")

    @property
    def grounded(self) -> bool:
        """Whether both ground contacts should be closed, and both muscles measure as discharged."""
        return self._contacts_grounded and all(abs(volts) < DISCHARGED_V for volts in self.measured_v)

    @property
    def _contacts_grounded(self) -> bool:
        return all(bridge.grounded for bridge in self.bridges)

    @property
    def measured_v(self) -> tuple[float, float]:
        """What the monitors say, corrected [V]; their sign is that of the polarity contacts."""
        upper, lower = (
            math.copysign(
                calibration.measured_v(self.hardware.monitor_v(channel, muscle.voltage_v)), muscle.voltage_v
            )
            for channel, (calibration, muscle) in enumerate(zip(self.calibrations, self.muscles, strict=True))
        )
        return upper, lower

    def receive(self, data: bytes) -> None:
        """Bytes from the host."""
        for line in self._lines.feed(data):
            self._obey(line)

    def tick(self) -> None:
        """One millisecond of board and muscles."""
        if self.tick_dead:
            self._unfed_ms += 1
            if self._unfed_ms >= WATCHDOG_MS:
                self.reset("watchdog")
        else:
            self._control()
        for channel, (bridge, muscle) in enumerate(zip(self.bridges, self.muscles, strict=True)):
            set_point_v = min(self.calibrations[channel].set_point_v(bridge.set_point_v), MONITOR_V)
            contact = self.hardware.contact(channel, bridge.contact)
            muscle.step(1e-3, contact, set_point_v * self.hardware.set_point_gain[channel])
        self._telemetry_ms += 1
        if self._telemetry_ms >= self.settings["TELEMETRY"]:
            self._telemetry_ms = 0
            self._report()

    def _control(self) -> None:
        self._time_ms += 1
        self._heartbeat_ms += 1
        self._watch_interlock()
        self._watch_ground()
        if self.mode.may_be_live:
            self._watch()
        self.wanted = self._wanted() if self.mode.may_be_live else (0, 0)
        for bridge, voltage, measured in zip(self.bridges, self.wanted, self.measured_v, strict=True):
            bridge.step(voltage, self.settings["SLEW"], measured, self.settings["DEADTIME"])

    def _watch_interlock(self) -> None:
        if not any(self.interlock_closed):
            self.discrepancy = False
        self._discrepancy_ms = self._discrepancy_ms + 1 if len(set(self.interlock_closed)) > 1 else 0
        if self._discrepancy_ms > DISCREPANCY_MS:
            self.discrepancy = True

    def _watch_ground(self) -> None:
        for channel, (bridge, volts) in enumerate(zip(self.bridges, self.measured_v, strict=True)):
            charged = bridge.grounded and abs(volts) >= DISCHARGED_V
            self._charged_ms[channel] = self._charged_ms[channel] + 1 if charged else 0
            if self._charged_ms[channel] >= GROUND_PROOF_MS:
                self.fail(FaultCode.NOT_GROUNDED)

    def _watch(self) -> None:
        if not all(self.interlock_closed):
            self.fail(FaultCode.INTERLOCK)
        elif self._heartbeat_ms > self.settings["HEARTBEAT"]:
            self.fail(FaultCode.HEARTBEAT)
        # A monitor at the end of its range cannot tell how much there is: that too is more than allowed.
        last = (MONITOR_STEPS - 1) / MONITOR_STEPS
        most_v = max(self.settings["MAXIMUM"] * 1.05, self.settings["MAXIMUM"] + 100)
        most_a = min(self.settings["TRIP"] * 1e-6, last * MONITOR_A)
        sources = [
            (abs(volts), abs(self.hardware.monitor_v(channel, muscle.voltage_v)))
            for channel, (volts, muscle) in enumerate(zip(self.measured_v, self.muscles, strict=True))
            if self.bridges[channel].contact.sign
        ]
        over = {
            FaultCode.OVERCURRENT: any(m.current_a > most_a for m in self.muscles),
            FaultCode.OVERVOLTAGE: any(v > most_v or monitor > last * MONITOR_V for v, monitor in sources),
        }
        for code, exceeded in over.items():
            self._over_ms[code] = self._over_ms[code] + 1 if exceeded else 0
            if self._over_ms[code] >= CONFIRMATION_MS:
                self.fail(code)

    def _wanted(self) -> tuple[int, int]:
        if self.waveform_ms is None:
            return self.voltage
        time_s = self.waveform_ms * 1e-3
        self.waveform_ms += 1
        if time_s >= self.waveform.duration_s:
            self.set_voltage((0, 0))
            self._send("!WAVEFORM DONE")
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
        report = protocol.Telemetry(
            time_us=self._time_ms * 1000,
            mode=Mode.ACTIVE if falling else self.mode,
            grounded=self.grounded,
            fault_code=self.fault,
            voltage=self.wanted if self.mode.may_be_live else (0, 0),
            measured=(measured[0], measured[1]),
            current=(round(upper.current_a * 1e6), round(lower.current_a * 1e6)),
            interlock=(self.interlock_closed[0], self.interlock_closed[1]),
            maximum=self.settings["MAXIMUM"],
        )
        self.transmitted += protocol.encode_telemetry(report)

    def _send(self, text: str) -> None:
        self.transmitted += protocol.encode(text)

    def ground(self, mode: Mode) -> None:
        """Converters off, contacts on their way to ground."""
        self.mode, self.voltage, self.waveform_ms = mode, (0, 0), None
        for bridge in self.bridges:
            bridge.release()

    def fail(self, code: FaultCode) -> None:
        """Ground and latch the first fault."""
        self.ground(Mode.FAULT)
        if self.fault is FaultCode.NONE:
            self.fault = code
            self._send(f"!FAULT {int(code)} {code.name}")

    def set_voltage(self, voltage: tuple[int, int]) -> None:
        """Ask for a voltage [V], within MAXIMUM; ends a waveform."""
        self.voltage, self.waveform_ms = voltage, None
        self.mode = Mode.ACTIVE if any(voltage) else Mode.ARMED

    def _obey(self, line: bytes) -> None:
        try:
            command = protocol.parse_command(line)
        except ProtocolError:
            self._refuse_line(line)
            return
        if self.mode.may_be_live and command.sequence != (self._sequence + 1) % protocol.SEQUENCE_MODULUS:
            self.fail(FaultCode.SEQUENCE)
            self._send(f"<{command.sequence:03d} ERR SEQUENCE " + " ".join(command.words))
            return
        self._sequence, self._heartbeat_ms = command.sequence, 0
        try:
            answer = "OK " + execute(self, command.words)
        except RefusalError as refusal:
            answer = f"ERR {refusal} " + " ".join(command.words)
        self._send(f"<{command.sequence:03d} {answer}")

    def _refuse_line(self, line: bytes) -> None:
        try:
            protocol.decode(line)
        except ProtocolError:
            self._send("<--- ERR CHECKSUM")
        else:
            self._send("<--- ERR SYNTAX")
        if self.mode.may_be_live:
            self.fail(FaultCode.GARBAGE)
