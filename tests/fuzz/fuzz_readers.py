# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`make fuzz`: other people's files, damaged in every way. No stack trace, no hang, no memory without end, and never a
silent difference: what is read is what an independent reader reads (pandas, mcap's own, PyAV), or a sentence was said.
"""

import io
import os
import resource
import struct
import tempfile
import time
import warnings
from pathlib import Path

import av
import numpy as np
import pandas
import pytest
from hasel_common.declared_parameters import _fitting
from hasel_common.node_parameter import NodeParameter
from hasel_recording import Recording, RecordingError, read_recording, write_recording
from hasel_recording.bag import read_file
from hasel_recording.csv_columns import parse_map
from hasel_tracker.errors import TrackerError
from hasel_tracker.sources.video_source import VideoSource
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from mcap.exceptions import McapError
from mcap.records import Message
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, Writer
from rclpy.parameter import Parameter

SHARE = float(os.environ.get("FUZZ_SHARE", "1"))
LONGEST_S, MOST_MB = 10.0, 1000.0
FOLDER = Path(tempfile.mkdtemp(prefix="fuzz-"))


def inputs(count: int):
    """How many inputs a fuzzer tries."""
    return settings(
        max_examples=max(1, round(SHARE * count)),
        deadline=None,
        database=None,
        suppress_health_check=list(HealthCheck),
    )


@pytest.fixture(autouse=True)
def bounded():
    """Memory stays bounded over a whole fuzzer."""
    yield
    used = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    assert used < MOST_MB, f"{used:.0f} MB"


def told(work, refusals):
    """What `work` gives (None where it was refused), and whether anything was said; in bounded time."""
    begun = time.monotonic()
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            result = work()
        except refusals as error:
            assert "\n" not in str(error)
            result = None
    assert time.monotonic() - begun < LONGEST_S
    return result, bool(said)


def damaged(content: bytes, data: st.DataObject) -> bytes:
    """The bytes with up to four holes, cuts, flips or insertions."""
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, max(0, len(content) - 1)))
        length = data.draw(st.sampled_from([1, 2, 8, 60, 700]))
        other = data.draw(st.binary(min_size=1, max_size=16))
        content = data.draw(
            st.sampled_from(
                [
                    content[:at],
                    content[:at] + bytes(len(content) - at),
                    content[:at] + bytes(length) + content[at + length :],
                    content[:at] + content[at + length :],
                    content[:at] + other + content[at:],
                    content[:at] + other + content[at + len(other) :],
                ]
            )
        )
    return content


ROWS = "".join(
    f"{number / 120:.6f},{3500 * (number % 20 < 10)},0,{0.1 * np.sin(number / 9):.6f}\n"
    for number in range(60)
)
TABLE = "time_s,voltage_upper_v,voltage_lower_v,sin_theta\n" + ROWS
SIGNS = st.sampled_from(
    [*'",;\t \n\r#.-+eE0127\'"', "\u00a0", "\u2009", "\x85", "nan", "1,100", "1.100", '"1,100"', "\u20ac"]
)


@inputs(9000)
@given(st.data())
def fuzz_csv(data):
    """A table with signs put in, taken out and exchanged: equal to what pandas reads, or something is said."""
    text = TABLE
    for _ in range(data.draw(st.integers(1, 5))):
        at = data.draw(st.integers(0, len(text)))
        text = text[:at] + data.draw(SIGNS) + text[at + data.draw(st.integers(0, 3)) :]
    path = FOLDER / "run.csv"
    path.write_bytes(text.encode("utf-8"))
    run, said = told(lambda: read_recording(path), RecordingError)
    if run is None or said or any(sign in text for sign in ("\x85", "\u00a0", "\u2009", "'", ";", "\t")):
        return
    try:
        other = pandas.read_csv(io.StringIO(text), comment="#", skipinitialspace=True, index_col=False)
        columns = [pandas.to_numeric(other[name]).to_numpy(float) for name in ("time_s", "sin_theta")]
    except (ValueError, KeyError, pandas.errors.ParserError):
        return
    if len(columns[0]) == len(run.time_s):
        np.testing.assert_allclose(run.time_s, columns[0], rtol=1e-12)
        np.testing.assert_allclose(run.sin_theta, columns[1], rtol=1e-12)


@inputs(1000)
@given(st.text(max_size=60))
def fuzz_map(text):
    """Any text after --map is pairs, or a sentence."""
    told(lambda: parse_map(text), RecordingError)


def mcap_files() -> list[bytes]:
    """One run, written in five ways."""
    times = np.round(np.arange(120) / 120, 6)
    upper = np.where(times % 0.5 < 0.25, 3500.0, 0.0)
    write_recording(
        Recording("run", times, 0.1 * np.sin(4 * np.pi * times), np.column_stack([upper, 3500 - upper])),
        FOLDER / "a.mcap",
    )
    source, found = read_file(FOLDER / "a.mcap"), [(FOLDER / "a.mcap").read_bytes()]
    for options in (
        {"use_chunking": False, "enable_data_crcs": True},
        {"compression": CompressionType.LZ4, "chunk_size": 9000},
        {"compression": CompressionType.NONE, "chunk_size": 9000},
        {"compression": CompressionType.ZSTD, "chunk_size": 9000, "enable_data_crcs": True},
    ):
        file = io.BytesIO()
        writer = Writer(file, **options)
        writer.start(profile="ros2")
        channels = {}
        for topic, (encoding, schema) in source.kinds.items():
            number = writer.register_schema(schema.name, schema.encoding, schema.data)
            channels[topic] = writer.register_channel(topic, encoding, number)
        messages = [(topic, each) for topic, every in source.messages.items() for each in every]
        for topic, message in sorted(messages, key=lambda pair: pair[1].log_time):
            writer.add_message(channels[topic], message.log_time, message.data, message.publish_time)
        writer.finish()
        found.append(file.getvalue())
    return found


MCAP = mcap_files()


@inputs(7000)
@given(st.data())
def fuzz_mcap(data):
    """Damaged recordings: every message as mcap's own reader gives it, or something is said."""
    content = damaged(data.draw(st.sampled_from(MCAP)), data)
    path = FOLDER / "run.mcap"
    path.write_bytes(content)
    told(lambda: read_recording(path), RecordingError)
    file, said = told(lambda: read_file(path), RecordingError)
    if file is None or said:
        return
    try:
        records = list(StreamReader(io.BytesIO(content), validate_crcs=True).records)
    except (McapError, ValueError, RuntimeError, OverflowError, struct.error):
        return
    theirs = sorted((r.log_time, r.data) for r in records if isinstance(r, Message))
    assert sorted((m.log_time, m.data) for ms in file.messages.values() for m in ms) == theirs


def video() -> bytes:
    """A small H.264 film."""
    file = io.BytesIO()
    with av.open(file, "w", format="mp4") as container:
        stream = container.add_stream("libx264", rate=30)
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
        for number in range(12):
            image = np.full((48, 64, 3), 20 * number, np.uint8)
            container.mux(stream.encode(av.VideoFrame.from_ndarray(image, format="bgr24")))
        container.mux(stream.encode())
    return file.getvalue()


FILM = video()


@inputs(2000)
@given(st.data())
def fuzz_video(data):
    """A damaged film gives its pictures with increasing times, or a sentence."""
    path = FOLDER / "film.mp4"
    path.write_bytes(damaged(FILM, data))
    told(lambda: sum(frame.image.size for frame in VideoSource(path, threads=1)), TrackerError)


PARAMETERS = [
    NodeParameter("a", 1.0, "a number", "V", 0, 9),
    NodeParameter("b", 3, "a whole number"),
    NodeParameter("c", "x", "a text"),
    NodeParameter("d", True, "a switch"),
    NodeParameter("e", [""], "words"),
    NodeParameter("f", [0.0], "numbers"),
]
SINGLE = st.one_of(st.booleans(), st.integers(-(2**62), 2**62), st.floats(), st.text(max_size=9))
VALUES = st.one_of(
    SINGLE,
    st.lists(st.integers(-9, 9), min_size=1, max_size=3),
    st.lists(st.floats(), min_size=1, max_size=3),
    st.lists(st.text(max_size=4), min_size=1, max_size=3),
)


@inputs(3000)
@given(st.sampled_from(PARAMETERS), VALUES)
def fuzz_parameters(parameter, value):
    """Whatever is given to a parameter: the same value in its type, or as it was given."""
    taken = _fitting(parameter, Parameter(parameter.name, value=value)).value
    if isinstance(parameter.default, str):
        assert isinstance(taken, (str, list, tuple)) or not np.isscalar(taken)
