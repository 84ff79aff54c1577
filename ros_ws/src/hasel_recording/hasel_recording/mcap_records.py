# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The records of an MCAP file, also of one that is cut off, full of holes or whose bits have flipped.

What is whole is read before the damage and behind it; a chunk counts as whole if its checksum fits.
"""

import mmap
import re
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import EndOfFile
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, DataEnd, McapRecord, Message, Metadata, Schema
from mcap.stream_reader import get_chunk_data_stream

MAGIC = b"\x89MCAP0\r\n"
HEAD = struct.Struct("<BQ")
READERS = {
    Opcode.CHANNEL: Channel.read,
    Opcode.SCHEMA: Schema.read,
    Opcode.METADATA: Metadata.read,
    Opcode.CHUNK: Chunk.read,
    Opcode.DATA_END: DataEnd.read,
}
RECORD = re.compile(rb"[\x02-\x0f].{4}\x00{4}", re.DOTALL)
"""How a record of less than 4 GiB begins."""
LARGEST_CHUNK = 1 << 28
UNREADABLE = (EndOfFile, struct.error, OverflowError, UnicodeDecodeError, ValueError, RuntimeError)
"""What reading a record raises whose bytes make no sense."""
Bytes = bytes | mmap.mmap


class _Exact(ReadDataStream):
    """A stream that never gives less than was asked for."""

    def read(self, length: int) -> bytes:
        data = super().read(length)
        if len(data) < length:
            raise EndOfFile()
        return data


@dataclass
class Damage:
    """What could not be read. lost: (first, last) log time [ns] of chunks; unread: bytes between records; nameless:
    messages whose topic was lost; checksum: whether that of the whole file does not fit; cut: whether it has no end;
    rest: bytes of a record that was not finished.
    """

    lost: list[tuple[int, int]] = field(default_factory=list)
    unread: int = 0
    nameless: int = 0
    checksum: bool = False
    cut: bool = False
    rest: int = 0

    def sentences(self) -> list[str]:
        """What to tell, after the file's name."""
        said = []
        parts = [f"{self.unread} bytes"] if self.unread else []
        parts += [f"{self.nameless} messages without a topic"] if self.nameless else []
        if self.lost:
            seconds = sum(max(0, last - first) for first, last in self.lost) * 1e-9
            parts.append(f"{len(self.lost)} chunks ({seconds:.3g} s of messages)")
        if parts:
            said.append(f"is damaged: {' and '.join(parts)} were left out, the rest was read.")
        elif self.checksum:
            said.append(
                "is damaged: its checksum does not fit, so that what it says may be wrong; restore it from a copy."
            )
        if self.cut:
            said.append("is truncated (its writer was killed?); it was read to the last whole message.")
        return said


def whole_records(data: Bytes, damage: Damage) -> Iterator[McapRecord]:
    """Channels, schemas, messages and metadata of a file, in their order; what is not whole is noted in `damage`."""
    place = len(MAGIC) if data[: len(MAGIC)] == MAGIC else 0
    while place < len(data):
        record = _whole(data, place)
        if record is None:
            found = _next_record(data, place)
            if found is None:
                damage.cut, damage.rest = True, len(data) - place
                return
            damage.unread += found - place
            place = found
            continue
        opcode, content, place = record
        if opcode == Opcode.FOOTER:
            return
        if isinstance(content, DataEnd):
            checksum = zlib.crc32(data[: place - HEAD.size - 4])  # of all before this record
            damage.checksum |= content.data_section_crc not in (0, checksum)
        elif isinstance(content, Chunk):
            try:
                yield from _of_chunk(content)
            except UNREADABLE:
                damage.lost.append((content.message_start_time, content.message_end_time))
        elif content is not None:
            yield content
    damage.cut = True


def _whole(data: Bytes, place: int) -> tuple[int, McapRecord | None, int] | None:
    """Opcode, content (None: of no interest here) and end of the record at a place; None where there is none."""
    if place + HEAD.size > len(data):
        return None
    opcode, length = HEAD.unpack_from(data, place)
    begin, end = place + HEAD.size, place + HEAD.size + length
    if not Opcode.HEADER <= opcode <= Opcode.DATA_END or end > len(data):
        return None
    if opcode not in READERS and opcode != Opcode.MESSAGE:
        return opcode, None, end
    stream = _Exact(BytesIO(data[begin:end]))
    try:
        content = Message.read(stream, length) if opcode == Opcode.MESSAGE else READERS[opcode](stream)
    except UNREADABLE:
        return None
    return opcode, content, end


def _next_record(data: Bytes, place: int) -> int | None:
    """Where the next record begins after a place: something that looks like one, and another one after it."""
    for match in RECORD.finditer(data, place + 1):
        start = match.start()
        end = start + HEAD.size + HEAD.unpack_from(data, start)[1]
        if end > len(data) or not (RECORD.match(data, end) or data[end : end + len(MAGIC)] == MAGIC):
            continue
        if _whole(data, start) is not None:
            return start
    return None


def _of_chunk(chunk: Chunk) -> Iterator[McapRecord]:
    """The records of a chunk; raises one of UNREADABLE where it is damaged, before any is given."""
    if chunk.uncompressed_size > LARGEST_CHUNK:
        raise ValueError("larger than any chunk")
    try:
        stream, length = get_chunk_data_stream(chunk, validate_crc=True)
    except Exception as error:  # noqa: BLE001  what unpacks a chunk raises what it likes
        raise ValueError(str(error)) from None
    if length != chunk.uncompressed_size:
        raise ValueError("of another size than it says")
    data, place, records = stream.read(length), 0, []
    while place < length:
        record = _whole(data, place)
        if record is None:
            raise EndOfFile()
        _, content, place = record
        records.append(content)
    yield from (content for content in records if content is not None)
