import pytest
from hasel_recording import RecordingError, RecordingWarning, read_recording, write_recording
from hasel_recording.mcap_file import read_file
from hasel_recording.topics import MEASURED, STATE
from mcap.stream_reader import StreamReader
from mcap.writer import CompressionType, Writer


def count(path) -> int:
    """Return the number of messages in all topics."""
    return sum(len(messages) for messages in read_file(path).messages.values())


@pytest.fixture
def mcap_file(driven, tmp_path):
    """The driven run as MCAP: 240 states and 240 angles in several chunks."""
    write_recording(driven, tmp_path / "run.mcap")
    return tmp_path / "run.mcap"


@pytest.mark.filterwarnings("ignore::hasel_recording.RecordingWarning")
def test_cut_anywhere_gives_every_whole_chunk(mcap_file):
    """Wherever a file is cut, all chunks before the cut are read, and nothing else happens."""
    whole = mcap_file.read_bytes()
    with mcap_file.open("rb") as file:
        chunks = [
            record
            for record in StreamReader(file, emit_chunks=True).records
            if hasattr(record, "uncompressed_size")
        ]
    assert len({chunk.message_end_time for chunk in chunks}) > 2
    counts = []
    for size in range(200, len(whole), 97):
        mcap_file.write_bytes(whole[:size])
        counts.append(count(mcap_file))
    assert counts == sorted(counts)
    assert counts[0] == 0
    assert counts[-1] == 480


def test_truncated_file_is_read_with_a_warning(mcap_file):
    """Half a file is half a recording, and the reader says that it was cut."""
    whole = mcap_file.read_bytes()
    mcap_file.write_bytes(whole[: len(whole) // 2])
    with pytest.warns(RecordingWarning, match="truncated"):
        recording = read_recording(mcap_file)
    assert 0 < len(recording.time_s) < 240


def test_damaged_chunk_is_an_error(mcap_file):
    """A flipped bit inside a chunk is not taken for data."""
    content = bytearray(mcap_file.read_bytes())
    with mcap_file.open("rb") as file:
        chunk = next(
            record for record in StreamReader(file, emit_chunks=True).records if hasattr(record, "data")
        )
    position = bytes(content).index(chunk.data) + len(chunk.data) // 2
    content[position] ^= 0xFF
    mcap_file.write_bytes(content)
    with pytest.raises(RecordingError, match="is damaged"):
        read_recording(mcap_file)


@pytest.mark.parametrize(
    ("content", "message"), [(b"", "is empty"), (b"time_s,sin_theta\n0,1\n", "not an MCAP file")]
)
def test_file_that_is_no_mcap(content, message, tmp_path):
    """An empty file and one of another kind are told apart."""
    (tmp_path / "run.mcap").write_bytes(content)
    with pytest.raises(RecordingError, match=message):
        read_recording(tmp_path / "run.mcap")


@pytest.mark.parametrize("options", [{"use_chunking": False}, {"compression": CompressionType.LZ4}])
def test_reads_the_other_ways_of_writing(options, mcap_file, tmp_path):
    """Files without chunks (rosbag2's fastwrite) and with lz4 hold the same run."""
    source = read_file(mcap_file)
    with (tmp_path / "other.mcap").open("wb") as file:
        writer = Writer(file, **options)
        writer.start(profile="ros2")
        for topic in (STATE, MEASURED):
            channel = source.channels[source.messages[topic][0].channel_id]
            schema = source.schemas[channel.schema_id]
            schema_id = writer.register_schema(schema.name, schema.encoding, schema.data)
            channel_id = writer.register_channel(topic, "cdr", schema_id)
            for message in source.messages[topic]:
                writer.add_message(channel_id, message.log_time, message.data, message.publish_time)
        writer.finish()
    other, original = read_recording(tmp_path / "other.mcap"), read_recording(mcap_file)
    assert other.sin_theta.tolist() == original.sin_theta.tolist()
    assert other.voltage.tolist() == original.voltage.tolist()
