from pathlib import Path

import yaml
from hasel_common.topics import COMMAND
from hasel_recording import McapRecorder
from hasel_recording.mcap_file import read_file
from rosbags.rosbag2 import Reader


def make_bag(folder: Path) -> Path:
    """Record two messages and put `metadata.yaml` beside them, taken from the file's own record."""
    with McapRecorder(folder / "bag_0.mcap", {"model": "swimmer"}) as recorder:
        for stamp_ns in (1_000_000_000, 3_500_000_000):
            recorder.write(COMMAND, {"voltage": [3500.0, 0.0]}, stamp_ns)
    record = read_file(folder / "bag_0.mcap").metadata["rosbag2"]["serialized_metadata"]
    text = yaml.safe_dump({"rosbag2_bagfile_information": yaml.safe_load(record)})
    (folder / "metadata.yaml").write_text(text)
    return folder


def test_independent_reader_accepts_the_bag(tmp_path):
    """With our metadata as metadata.yaml, rosbags opens the folder as a rosbag2 bag with the right counts."""
    with Reader(make_bag(tmp_path)) as bag:
        assert bag.message_count == 2
        assert bag.duration >= 2_500_000_000
        assert bag.ros_distro == "jazzy"
        assert len(list(bag.messages())) == 2
        (connection,) = bag.connections
        assert connection.msgtype == "hasel_interfaces/msg/Actuation"


def test_quality_of_service_is_understood(tmp_path):
    """The channel's offered_qos_profiles parses to one reliable, volatile, keep-last profile."""
    with Reader(make_bag(tmp_path)) as bag:
        (qos,) = bag.connections[0].ext.offered_qos_profiles
    assert (qos.reliability.name, qos.durability.name, qos.history.name) == (
        "RELIABLE",
        "VOLATILE",
        "KEEP_LAST",
    )
    assert qos.deadline.sec == 9223372036
