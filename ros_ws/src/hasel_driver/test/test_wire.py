# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Encoding, checksum and parsing of lines, against the examples in PROTOCOL.md and against anything at all."""

import re
from pathlib import Path

import pytest
from hasel_driver.protocol import wire
from hasel_driver.protocol.faults import ProtocolError
from hasel_driver.protocol.status import Ground, Mode
from hasel_driver.protocol.wire import LineBuffer
from hypothesis import given
from hypothesis import strategies as st

DOCUMENT = (Path(__file__).parents[1] / "firmware" / "PROTOCOL.md").read_text()
WORDS = st.lists(
    st.text("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_", min_size=1, max_size=8), min_size=1, max_size=8
)
VOLTS = st.integers(-10_000, 10_000)
TELEMETRY = st.builds(
    wire.Telemetry,
    time_us=st.integers(0, 2**32 - 1),
    mode=st.sampled_from(Mode),
    ground=st.sampled_from(Ground),
    fault_code=st.integers(0, 255),
    voltage=st.tuples(VOLTS, VOLTS),
    measured=st.tuples(VOLTS, VOLTS),
    current=st.tuples(st.integers(0, 1000), st.integers(0, 1000)),
    interlock=st.tuples(st.booleans(), st.booleans()),
    maximum=st.integers(0, 9800),
)


def test_checksum_has_the_published_check_value():
    """CRC-16/XMODEM of "123456789" is 31C3 in every catalogue of CRCs."""
    assert wire.checksum(b"123456789") == 0x31C3


def test_every_example_of_the_document_parses():
    """The lines shown in PROTOCOL.md are valid and mean what is said there."""
    examples = re.findall(r"^([><#]\S.*?\*[0-9A-F]{4})", DOCUMENT, re.MULTILINE)
    assert len(examples) == 3
    assert wire.parse_command(examples[0].encode()).words == ("SET", "VOLTAGE", "6500", "-2000")
    assert wire.parse_device_line(examples[1].encode()) == wire.Reply(17, True, ("VOLTAGE", "6500", "-2000"))
    assert wire.parse_device_line(examples[2].encode()) == wire.Telemetry(
        123456789, Mode.ACTIVE, False, 0, (6500, -2000), (6497, -1998), (12, 8), (True, True), 7000
    )


@given(st.integers(0, 255), WORDS)
def test_commands_survive_the_line(sequence, words):
    """What is encoded is what is parsed."""
    line = wire.encode_command(sequence, *words)
    if len(line) - 1 <= wire.MAXIMUM_LINE_LENGTH:
        assert wire.parse_command(line.rstrip(b"\n")) == wire.Command(sequence, tuple(words))


@given(TELEMETRY)
def test_telemetry_survives_the_line(report):
    """Every possible report fits into a line and comes back the same."""
    line = wire.encode_telemetry(report).rstrip(b"\n")
    assert len(line) <= wire.MAXIMUM_LINE_LENGTH
    assert wire.parse_device_line(line) == report


@given(st.binary(max_size=200))
def test_anything_else_is_a_protocol_error(data):
    """No bytes at all make the parsers do anything but raise ProtocolError."""
    for parse in (wire.parse_command, wire.parse_device_line):
        with pytest.raises(ProtocolError):
            parse(data)


@given(st.text(st.characters(codec="ascii"), max_size=80))
def test_a_right_checksum_alone_does_not_make_a_line(text):
    """Text with a valid checksum is parsed or refused, never anything else."""
    line = wire.encode(text).rstrip(b"\n")
    for parse in (wire.parse_command, wire.parse_device_line):
        try:
            parse(line)
        except ProtocolError:
            continue


@pytest.mark.parametrize("text", [">001  ", "<001 OK  ", "<001 ERR  ", "! ", ">256 PING", ">001" + 11 * " A"])
def test_lines_without_sense_are_protocol_errors(text):
    """Nothing but spaces, a number that is none, and too many words: refused in spite of a right checksum."""
    for parse in (wire.parse_command, wire.parse_device_line):
        with pytest.raises(ProtocolError):
            parse(wire.encode(text).rstrip(b"\n"))


@given(TELEMETRY, st.data())
def test_one_or_two_flipped_bits_are_found(report, data):
    """The checksum finds every error of one or two bits, and so does a cut."""
    line = bytearray(wire.encode_telemetry(report).rstrip(b"\n"))
    bits = data.draw(st.lists(st.integers(0, 8 * len(line) - 1), min_size=1, max_size=2, unique=True))
    for bit in bits:
        line[bit // 8] ^= 1 << bit % 8
    with pytest.raises(ProtocolError):
        wire.parse_device_line(bytes(line))
    with pytest.raises(ProtocolError):
        wire.parse_device_line(bytes(line[: data.draw(st.integers(0, len(line) - 1))]))


@given(st.lists(TELEMETRY, max_size=5), st.lists(st.integers(1, 40), min_size=1, max_size=20))
def test_lines_do_not_depend_on_how_the_bytes_arrive(reports, sizes):
    """A stream cut anywhere gives the same lines."""
    stream = b"".join(wire.encode_telemetry(report) for report in reports)
    buffer, lines = LineBuffer(), []
    while stream:
        size = sizes[len(lines) % len(sizes)]
        lines += buffer.feed(stream[:size])
        stream = stream[size:]
    assert [wire.parse_device_line(line) for line in lines] == reports


def test_an_endless_line_is_not_kept_for_ever():
    """A stream without line ends comes out as garbage instead of filling the memory."""
    buffer = LineBuffer()
    pieces = [piece for _ in range(100) for piece in buffer.feed(b"x" * 50)]
    assert sum(map(len, pieces)) > 4000
    with pytest.raises(ProtocolError, match="at most 96"):
        wire.parse_device_line(pieces[0])
