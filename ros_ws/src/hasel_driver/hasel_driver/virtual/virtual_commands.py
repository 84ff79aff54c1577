# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Commands of the virtual board: what each does, or why it is refused (`firmware/PROTOCOL.md`)."""

import re
from collections.abc import Callable

from hasel_driver.protocol import wire
from hasel_driver.protocol.calibration import CALIBRATION_RANGES, Calibration
from hasel_driver.protocol.faults import FaultCode, LimitError, ProtocolError
from hasel_driver.protocol.limits import LEAST_PULSE_V, MUSCLE_NAMES
from hasel_driver.protocol.status import Mode
from hasel_driver.protocol.waveform import Waveform
from hasel_driver.virtual.virtual_board import SETTINGS, Latch, VirtualBoard


class RefusalError(Exception):
    """A command that is answered with ERR and this reason."""


def receive(board: VirtualBoard, data: bytes) -> None:
    """Bytes from the host: obey every whole line, and answer it."""
    for line in board.lines.feed(data):
        _obey(board, line)


def _obey(board: VirtualBoard, line: bytes) -> None:
    try:
        command = wire.parse_command(line)
    except ProtocolError:
        _refuse_line(board, line)
        return
    if board.mode.may_be_live and command.sequence != (board.sequence + 1) % wire.SEQUENCE_MODULUS:
        board.fail(FaultCode.SEQUENCE)
        board.send(f"<{command.sequence:03d} ERR SEQUENCE " + " ".join(command.words))
        return
    board.sequence, board.heartbeat_ms = command.sequence, 0
    try:
        answer = "OK " + _execute(board, command.words)
    except RefusalError as refusal:
        answer = f"ERR {refusal} " + " ".join(command.words)
    board.send(f"<{command.sequence:03d} {answer}")


def _refuse_line(board: VirtualBoard, line: bytes) -> None:
    try:
        wire.decode(line)
    except ProtocolError:
        board.send("<--- ERR CHECKSUM")
    else:
        board.send("<--- ERR SYNTAX")
    if board.mode.may_be_live:
        board.fail(FaultCode.GARBAGE)


def _execute(board: VirtualBoard, words: tuple[str, ...]) -> str:
    """Obey a command; the words of the reply after OK. Raises RefusalError."""
    simple: dict[str, Callable[[], None]] = {
        "PING": lambda: None,
        "ARM": lambda: _arm(board),
        "DISARM": lambda: board.release(Mode.STANDBY if board.fault is FaultCode.NONE else Mode.FAULT),
        "STOP": lambda: board.fail(FaultCode.STOP),
        "CLEAR": lambda: _clear(board),
        "START": lambda: _start(board),
        "GROUND": lambda: _ground(board),
    }
    if words[0] in simple:
        if len(words) > 1:
            raise RefusalError("SYNTAX")
        simple[words[0]]()
        return words[0]
    if words[0] not in ("SET", "GET") or len(words) < 2:
        raise RefusalError("UNKNOWN")
    if words[0] == "SET":
        _set(board, words[1], words[2:])
        if words[1] == "CALIBRATION":
            words = words[:3]
    elif words[1] == "CALIBRATION":
        if len(words) != 3 or words[2] not in MUSCLE_NAMES:
            raise RefusalError("SYNTAX")
    elif len(words) > 2:
        raise RefusalError("SYNTAX")
    if words[1] == "CALIBRATION":
        return f"CALIBRATION {words[2]} {board.calibrations[MUSCLE_NAMES.index(words[2])].words()}"
    return f"{words[1]} {_value(board, words[1])}"


def _value(board: VirtualBoard, quantity: str) -> str:
    if quantity == "IDENTITY":
        return " ".join(wire.IDENTITY)
    if quantity == "VOLTAGE":
        return f"{board.voltage[0]} {board.voltage[1]}"
    if quantity == "WAVEFORM":
        w = board.waveform
        numbers = (round(w.voltage_v), round(w.frequency_hz * 1e3), w.periods, round(w.duty * 1e3))
        return " ".join([w.shape, *map(str, numbers), w.polarity, w.muscles])
    if quantity in board.settings:
        return str(board.settings[quantity])
    raise RefusalError("UNKNOWN")


def _set(board: VirtualBoard, quantity: str, arguments: tuple[str, ...]) -> None:
    if quantity == "VOLTAGE":
        _require(board.mode.may_be_live and board.proof is None)
        most = board.settings["MAXIMUM"]
        upper, lower = _integers(arguments, 2)
        board.set_voltage((_clip(upper, -most, most), _clip(lower, -most, most)))
    elif quantity == "WAVEFORM":
        _require(board.mode is not Mode.ACTIVE)
        board.waveform = _parse_waveform(board, arguments)
    elif quantity == "CALIBRATION":
        _set_calibration(board, arguments)
    elif quantity in SETTINGS:
        _set_setting(board, quantity, arguments)
    else:
        raise RefusalError("UNKNOWN")


def _set_calibration(board: VirtualBoard, arguments: tuple[str, ...]) -> None:
    if len(arguments) != 5 or arguments[0] not in MUSCLE_NAMES:
        raise RefusalError("SYNTAX")
    values = _integers(arguments[1:], 4)
    _require(not board.mode.may_be_live)
    clipped = [
        _clip(value, *bounds) for value, bounds in zip(values, CALIBRATION_RANGES.values(), strict=True)
    ]
    board.calibrations[MUSCLE_NAMES.index(arguments[0])] = Calibration(*clipped)
    board.calibrations_damaged = False


def _set_setting(board: VirtualBoard, quantity: str, arguments: tuple[str, ...]) -> None:
    if board.mode.may_be_live and quantity not in ("MAXIMUM", "TELEMETRY"):
        raise RefusalError("STATE")
    least, most, _ = SETTINGS[quantity]
    try:
        value = _clip(_integers(arguments, 1)[0], least, most)
    except RefusalError:
        _require(not board.mode.may_be_live or quantity == "TELEMETRY")
        raise
    lowers = quantity == "MAXIMUM" and value <= board.settings["MAXIMUM"]
    _require(lowers or quantity == "TELEMETRY" or not board.mode.may_be_live)
    board.settings[quantity] = value
    if lowers:
        board.lower_maximum()


def _parse_waveform(board: VirtualBoard, arguments: tuple[str, ...]) -> Waveform:
    if len(arguments) != 7:
        raise RefusalError("SYNTAX")
    voltage, frequency, periods, duty = _integers(arguments[1:5], 4)
    try:
        return Waveform(
            shape=arguments[0],
            voltage_v=_clip(voltage, 0, board.settings["MAXIMUM"]),
            frequency_hz=_clip(frequency, 10, 50_000) / 1000,
            periods=_clip(periods, 1, 60_000),
            duty=_clip(duty, 1, 1000) / 1000,
            polarity=arguments[5],
            muscles=arguments[6],
        )
    except LimitError as error:
        raise RefusalError("SYNTAX") from error


def _require(allowed: bool) -> None:
    if not allowed:
        raise RefusalError("STATE")


def _require_safe(board: VirtualBoard) -> None:
    if not all(board.interlock_closed):
        raise RefusalError("INTERLOCK")
    if Latch.DISAGREED in board.latches:
        raise RefusalError("DISCREPANCY")
    if board.calibrations_damaged:
        raise RefusalError("EEPROM")
    if not board.grounded:
        raise RefusalError("UNPROVEN")


def _require_pulse(board: VirtualBoard) -> None:
    if board.settings["MAXIMUM"] < LEAST_PULSE_V:
        raise RefusalError("MAXIMUM")


def _arm(board: VirtualBoard) -> None:
    _require(board.mode is Mode.STANDBY)
    _require_safe(board)
    _require_pulse(board)
    board.begin_proof()


def _ground(board: VirtualBoard) -> None:
    _require(board.mode.may_be_live and board.proof is None)
    board.release(Mode.ARMED)


def _clear(board: VirtualBoard) -> None:
    _require(board.mode is Mode.FAULT)
    _require_safe(board)
    if Latch.UNPROVEN in board.latches:
        _require_pulse(board)
        board.begin_proof()
    else:
        board.mode, board.fault = Mode.STANDBY, FaultCode.NONE


def _start(board: VirtualBoard) -> None:
    _require(board.mode is Mode.ARMED)
    board.mode, board.waveform_ms = Mode.ACTIVE, 0


def _clip(value: int, least: int, most: int) -> int:
    return min(max(value, least), most)


def _integers(words: tuple[str, ...], count: int) -> list[int]:
    if len(words) != count or not all(re.fullmatch(r"-?[0-9]{1,6}", word) for word in words):
        raise RefusalError("SYNTAX")
    return [int(word) for word in words]
