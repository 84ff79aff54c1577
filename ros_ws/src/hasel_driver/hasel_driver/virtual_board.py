"""The supply's board in Python: the same protocol, states and faults as the sketch in `firmware/`."""

from collections.abc import Callable

from hasel_driver import protocol
from hasel_driver.errors import LimitError, ProtocolError
from hasel_driver.faults import FaultCode
from hasel_driver.line_buffer import LineBuffer
from hasel_driver.mode import Mode
from hasel_driver.virtual_bridge import VirtualBridge
from hasel_driver.virtual_muscle import VirtualMuscle
from hasel_driver.waveform import Waveform

CONFIRMATION_MS = 3  # a trip must hold this long
# quantity: (least, most, at boot)
SETTINGS: dict[str, tuple[int, int, int]] = {
    "MAXIMUM": (0, 10_000, 10_000),
    "SLEW": (1, 2_000, 400),
    "TRIP": (1, 1_000, 450),
    "HEARTBEAT": (100, 2_000, 500),
    "TELEMETRY": (10, 1_000, 10),
}


class _RefusalError(Exception):
    """A command that is answered with ERR and this reason."""


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
        self._voltage = (0, 0)
        self._waveform = Waveform("box", 0, 1.0, 1)
        self._waveform_ms: int | None = None
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
            self._fail(FaultCode.INTERLOCK)
        elif self._heartbeat_ms > self.settings["HEARTBEAT"]:
            self._fail(FaultCode.HEARTBEAT)
        most_v = max(self.settings["MAXIMUM"] * 1.05, self.settings["MAXIMUM"] + 100)
        over = {
            FaultCode.OVERCURRENT: any(1e6 * m.current_a > self.settings["TRIP"] for m in self.muscles),
            FaultCode.OVERVOLTAGE: any(abs(m.voltage_v) > most_v for m in self.muscles),
        }
        for code, exceeded in over.items():
            self._over_ms[code] = self._over_ms[code] + 1 if exceeded else 0
            if self._over_ms[code] >= CONFIRMATION_MS:
                self._fail(code)

    def _wanted(self) -> tuple[int, int]:
        if self._waveform_ms is None:
            return self._voltage
        time_s = self._waveform_ms * 1e-3
        self._waveform_ms += 1
        if time_s >= self._waveform.duration_s:
            self._set_voltage((0, 0))
            self._send("!WAVEFORM DONE")
            return 0, 0
        upper, lower = self._waveform.voltage(time_s)
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

    def _ground(self, mode: Mode) -> None:
        self.mode, self._voltage, self._waveform_ms = mode, (0, 0), None
        for bridge in self.bridges:
            bridge.release()

    def _fail(self, code: FaultCode) -> None:
        self._ground(Mode.FAULT)
        if self.fault is FaultCode.NONE:
            self.fault = code
            self._send(f"!FAULT {int(code)} {code.name}")

    def _set_voltage(self, voltage: tuple[int, int]) -> None:
        self._voltage, self._waveform_ms = voltage, None
        self.mode = Mode.ACTIVE if any(voltage) else Mode.ARMED

    def _obey(self, line: bytes) -> None:
        try:
            command = protocol.parse_command(line)
        except ProtocolError:
            self._refuse_line(line)
            return
        if self.mode.may_be_live and command.sequence != (self._sequence + 1) % protocol.SEQUENCE_MODULUS:
            self._fail(FaultCode.SEQUENCE)
            self._send(f"<{command.sequence:03d} ERR SEQUENCE " + " ".join(command.words))
            return
        self._sequence, self._heartbeat_ms = command.sequence, 0
        try:
            answer = "OK " + self._execute(command.words)
        except _RefusalError as refusal:
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
            self._fail(FaultCode.GARBAGE)

    def _execute(self, words: tuple[str, ...]) -> str:
        simple: dict[str, Callable[[], None]] = {
            "PING": lambda: None,
            "ARM": self._arm,
            "DISARM": self._disarm,
            "STOP": lambda: self._fail(FaultCode.STOP),
            "CLEAR": self._clear,
            "START": self._start,
        }
        if words[0] in simple:
            if len(words) > 1:
                raise _RefusalError("SYNTAX")
            simple[words[0]]()
            return words[0]
        if words[0] not in ("SET", "GET") or len(words) < 2:
            raise _RefusalError("UNKNOWN")
        if words[0] == "SET":
            self._set(words[1], words[2:])
        elif len(words) > 2:
            raise _RefusalError("SYNTAX")
        return f"{words[1]} {self._value(words[1])}"

    def _value(self, quantity: str) -> str:
        if quantity == "IDENTITY":
            return " ".join(protocol.IDENTITY)
        if quantity == "VOLTAGE":
            return f"{self._voltage[0]} {self._voltage[1]}"
        if quantity == "WAVEFORM":
            w = self._waveform
            numbers = (round(w.voltage_v), round(w.frequency_hz * 1e3), w.periods, round(w.duty * 1e3))
            return " ".join([w.shape, *map(str, numbers), w.polarity, w.muscles])
        if quantity in self.settings:
            return str(self.settings[quantity])
        raise _RefusalError("UNKNOWN")

    def _set(self, quantity: str, arguments: tuple[str, ...]) -> None:
        if quantity == "VOLTAGE":
            self._require(self.mode.may_be_live)
            most = self.settings["MAXIMUM"]
            upper, lower = _integers(arguments, 2)
            self._set_voltage((_clip(upper, -most, most), _clip(lower, -most, most)))
        elif quantity == "WAVEFORM":
            self._require(self.mode is not Mode.ACTIVE)
            self._waveform = self._parse_waveform(arguments)
        elif quantity in SETTINGS:
            self._require(self.mode is Mode.STANDBY or quantity == "TELEMETRY")
            least, most, _ = SETTINGS[quantity]
            self.settings[quantity] = _clip(_integers(arguments, 1)[0], least, most)
        else:
            raise _RefusalError("UNKNOWN")

    def _parse_waveform(self, arguments: tuple[str, ...]) -> Waveform:
        if len(arguments) != 7:
            raise _RefusalError("SYNTAX")
        voltage, frequency, periods, duty = _integers(arguments[1:5], 4)
        try:
            return Waveform(
                shape=arguments[0],
                voltage_v=_clip(voltage, 0, self.settings["MAXIMUM"]),
                frequency_hz=_clip(frequency, 10, 50_000) / 1000,
                periods=_clip(periods, 1, 60_000),
                duty=_clip(duty, 1, 1000) / 1000,
                polarity=arguments[5],
                muscles=arguments[6],
            )
        except LimitError as error:
            raise _RefusalError("SYNTAX") from error

    def _require(self, allowed: bool) -> None:
        if not allowed:
            raise _RefusalError("STATE")

    def _arm(self) -> None:
        self._require(self.mode is Mode.STANDBY)
        if not self.interlock_closed:
            raise _RefusalError("INTERLOCK")
        self.mode = Mode.ARMED

    def _disarm(self) -> None:
        self._ground(Mode.STANDBY if self.fault is FaultCode.NONE else Mode.FAULT)

    def _clear(self) -> None:
        self._require(self.mode is Mode.FAULT)
        if not self.interlock_closed:
            raise _RefusalError("INTERLOCK")
        self.mode, self.fault = Mode.STANDBY, FaultCode.NONE

    def _start(self) -> None:
        self._require(self.mode is Mode.ARMED)
        self.mode, self._waveform_ms = Mode.ACTIVE, 0


def _clip(value: int, least: int, most: int) -> int:
    return min(max(value, least), most)


def _integers(words: tuple[str, ...], count: int) -> list[int]:
    if len(words) != count or any(len(word.lstrip("-")) > 6 for word in words):
        raise _RefusalError("SYNTAX")
    try:
        return [int(word) for word in words]
    except ValueError as error:
        raise _RefusalError("SYNTAX") from error
