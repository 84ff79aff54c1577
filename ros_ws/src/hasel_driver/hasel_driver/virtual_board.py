"""The supply's board in Python: the same protocol, states and faults as the sketch in `firmware/`."""

from hasel_driver import protocol
from hasel_driver.errors import ProtocolError
from hasel_driver.faults import FaultCode
from hasel_driver.line_buffer import LineBuffer
from hasel_driver.mode import Mode
from hasel_driver.virtual_bridge import VirtualBridge
from hasel_driver.virtual_commands import SETTINGS, RefusalError, execute
from hasel_driver.virtual_muscle import VirtualMuscle
from hasel_driver.waveform import Waveform

CONFIRMATION_MS = 3  # a trip must hold this long


class VirtualBoard:
    """Reads command bytes, is advanced by the millisecond, and collects its output in `transmitted`."""

    def __init__(self, muscles: tuple[VirtualMuscle, VirtualMuscle] | None = None) -> None:
        self.muscles = muscles or (VirtualMuscle(), VirtualMuscle())
        self.interlock_closed = True
        self.transmitted = bytearray()
        self.reset("power")

    def reset(self, cause: str) -> None:
        """Boot: grounded, disarmed, every setting at its default; the muscles keep their charge."""
        self.bridges = (VirtualBridge(), VirtualBridge())
        self.mode, self.fault = Mode.STANDBY, FaultCode.NONE
        self.settings = {name: initial for name, (_, _, initial) in SETTINGS.items()}
        self.voltage = (0, 0)
        self.waveform = Waveform("box", 0, 1.0, 1)
        self.waveform_ms: int | None = None
        self._time_ms = self._heartbeat_ms = self._telemetry_ms = 0
        self._over_ms = {FaultCode.OVERCURRENT: 0, FaultCode.OVERVOLTAGE: 0}
        self._sequence = 0
        self._lines = LineBuffer()
        self._send("!BOOT " + " ".join(protocol.IDENTITY) + f" reset={cause}")

    @property
    def grounded(self) -> bool:
        """Whether both ground contacts are closed."""
        return all(bridge.grounded for bridge in self.bridges)

    def receive(self, data: bytes) -> None:
        """Bytes from the host."""
        for line in self._lines.feed(data):
            self._obey(line)

    def tick(self) -> None:
        """One millisecond: watchdog, trips, waveform, output stage, muscles, telemetry."""
        self._time_ms += 1
        self._heartbeat_ms += 1
        if self.mode.may_be_live:
            self._watch()
        wanted = self._wanted() if self.mode.may_be_live else (0, 0)
        for bridge, muscle, voltage in zip(self.bridges, self.muscles, wanted, strict=True):
            bridge.step(voltage, self.settings["SLEW"], muscle.voltage_v)
            muscle.step(1e-3, bridge.contact, bridge.set_point_v)
        self._telemetry_ms += 1
        if self._telemetry_ms >= self.settings["TELEMETRY"]:
            self._telemetry_ms = 0
            self._report(wanted)

    def _watch(self) -> None:
        if not self.interlock_closed:
            self.fail(FaultCode.INTERLOCK)
        elif self._heartbeat_ms > self.settings["HEARTBEAT"]:
            self.fail(FaultCode.HEARTBEAT)
        most_v = max(self.settings["MAXIMUM"] * 1.05, self.settings["MAXIMUM"] + 100)
        over = {
            FaultCode.OVERCURRENT: any(1e6 * m.current_a > self.settings["TRIP"] for m in self.muscles),
            FaultCode.OVERVOLTAGE: any(abs(m.voltage_v) > most_v for m in self.muscles),
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
        upper, lower = self.waveform.voltage(time_s)
        return round(upper), round(lower)

    def _report(self, wanted: tuple[int, int]) -> None:
        upper, lower = self.muscles
        falling = self.mode is Mode.ARMED and not self.grounded
        report = protocol.Telemetry(
            time_us=self._time_ms * 1000,
            mode=Mode.ACTIVE if falling else self.mode,
            grounded=self.grounded,
            fault_code=self.fault,
            voltage=wanted,
            measured=(round(upper.voltage_v), round(lower.voltage_v)),
            current=(round(upper.current_a * 1e6), round(lower.current_a * 1e6)),
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
