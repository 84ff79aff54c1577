# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Lines of the serial protocol (`firmware/PROTOCOL.md`): encoding, checksum, parsing; no input or output."""

import binascii
import re
from dataclasses import dataclass

from hasel_driver.protocol.faults import ProtocolError
from hasel_driver.protocol.status import Ground, Mode

PROTOCOL_VERSION = 3
BAUD = 500_000
MAXIMUM_LINE_LENGTH = 96
MOST_WORDS = 10  # of a command
SEQUENCE_MODULUS = 256
IDENTITY = ("hasel-supply", "3.0", "protocol", str(PROTOCOL_VERSION))

_COMMAND = re.compile(r">(\d{3}) (.*\S.*)")
_REPLY = re.compile(r"<(\d{3}|---) (OK|ERR) (.*\S.*)")
_TELEMETRY = re.compile(
    r"#t=(\d{1,10}) s=([A-Z]+) g=([012]) f=(\d{1,3})"
    r" v=(-?\d{1,5}),(-?\d{1,5}) m=(-?\d{1,5}),(-?\d{1,5}) i=(\d{1,5}),(\d{1,5}) k=([01])([01]) x=(\d{1,5})"
)


@dataclass(frozen=True)
class Command:
    """A host's command: sequence number 0 … 255 and its words."""

    sequence: int
    words: tuple[str, ...]


@dataclass(frozen=True)
class Reply:
    """A board's reply; `sequence` is None where the command's could not be read."""

    sequence: int | None
    accepted: bool
    words: tuple[str, ...]


@dataclass(frozen=True)
class Event:
    """Something that happened on the board without being asked for."""

    words: tuple[str, ...]


@dataclass(frozen=True)
class Telemetry:
    """The board's periodic report; order upper, lower."""

    time_us: int
    mode: Mode
    ground: Ground
    fault_code: int
    voltage: tuple[int, int]  # V, asked for
    measured: tuple[int, int]  # V
    current: tuple[int, int]  # µA
    interlock: tuple[bool, bool] = (True, True)  # closed, by channel
    maximum: int = 0  # V, in force


Line = Reply | Event | Telemetry


def checksum(text: bytes) -> int:
    """CRC-16/XMODEM of `text`."""
    return binascii.crc_hqx(text, 0)


def encode(text: str) -> bytes:
    """`text` (with its first character) as a line: checksum and line end added."""
    body = text.encode("ascii")
    return body + b"*%04X\n" % checksum(body)


def encode_command(sequence: int, *words: object) -> bytes:
    """A command line from its words."""
    return encode(f">{sequence:03d} " + " ".join(str(word) for word in words))


def decode(line: bytes) -> str:
    """The text of a line without line end, its checksum proven.

    Raises:
        ProtocolError: the line is too long, not printable ASCII, or its checksum does not fit.
    """
    if len(line) > MAXIMUM_LINE_LENGTH:
        raise ProtocolError(f"a line has {len(line)} characters, at most {MAXIMUM_LINE_LENGTH} were expected")
    body, star, digits = line.rpartition(b"*")
    if not star or digits != b"%04X" % checksum(body):
        raise ProtocolError(f"the line {line!r} lacks its checksum, {checksum(body):04X} was expected")
    if not body.isascii() or not body.decode("ascii").isprintable():
        raise ProtocolError(f"the line {line!r} holds more than printable ASCII")
    return body.decode("ascii")


def parse_command(line: bytes) -> Command:
    """A host's line, as the board reads it."""
    text = decode(line)
    match = _COMMAND.fullmatch(text)
    words = tuple(match[2].split()) if match else ()
    if match is None or int(match[1]) >= SEQUENCE_MODULUS or len(words) > MOST_WORDS:
        raise ProtocolError(f"{text!r} is not a command, '>nnn WORDS' was expected")
    return Command(int(match[1]), words)


def parse_device_line(line: bytes) -> Line:
    """A board's line, as the host reads it."""
    text = decode(line)
    if text.startswith("#"):
        return _parse_telemetry(text)
    if text.startswith("!") and text[1:].strip():
        return Event(tuple(text[1:].split()))
    match = _REPLY.fullmatch(text)
    if match is None:
        raise ProtocolError(f"{text!r} is neither reply, event nor telemetry")
    sequence = None if match[1] == "---" else int(match[1])
    return Reply(sequence, match[2] == "OK", tuple(match[3].split()))


def _parse_telemetry(text: str) -> Telemetry:
    match = _TELEMETRY.fullmatch(text)
    if match is None or match[2] not in Mode.__members__:
        raise ProtocolError(f"{text!r} is not telemetry as of protocol version {PROTOCOL_VERSION}")
    numbers = [int(group) for group in match.groups()[3:]]
    return Telemetry(
        time_us=int(match[1]),
        mode=Mode[match[2]],
        ground=Ground(int(match[3])),
        fault_code=numbers[0],
        voltage=(numbers[1], numbers[2]),
        measured=(numbers[3], numbers[4]),
        current=(numbers[5], numbers[6]),
        interlock=(bool(numbers[7]), bool(numbers[8])),
        maximum=numbers[9],
    )


def encode_telemetry(report: Telemetry) -> bytes:
    """Telemetry as the board sends it."""
    return encode(
        f"#t={report.time_us % 2**32} s={report.mode.name} g={int(report.ground)} f={report.fault_code}"
        f" v={report.voltage[0]},{report.voltage[1]} m={report.measured[0]},{report.measured[1]}"
        f" i={report.current[0]},{report.current[1]}"
        f" k={int(report.interlock[0])}{int(report.interlock[1])} x={report.maximum}"
    )


class LineBuffer:
    """Collects bytes as they come; an endless line is handed out in pieces too long to be valid."""

    def __init__(self) -> None:
        self._pending = b""

    def feed(self, data: bytes) -> list[bytes]:
        """Whole lines, without line ends and without empty ones, in order."""
        *lines, self._pending = (self._pending + data).split(b"\n")
        if len(self._pending) > 2 * MAXIMUM_LINE_LENGTH:
            lines.append(self._pending)
            self._pending = b""
        return [line for line in (line.rstrip(b"\r") for line in lines) if line]

    def clear(self) -> None:
        """Forget a line that has only begun."""
        self._pending = b""
