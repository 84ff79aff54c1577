import pytest
from hasel_common.topics import TOPIC_TYPES
from hasel_recording import RecordingError
from hasel_recording.message_definitions import schema_text, type_hash
from rosbags.typesys import Stores, get_types_from_msg, get_typestore


@pytest.mark.parametrize("type_name", sorted(set(TOPIC_TYPES.values())))
def test_schema_and_hash_agree_with_an_independent_parser(type_name):
    """rosbags parses the schema of every type of the stack and computes the same type hash from it."""
    typestore = get_typestore(Stores.EMPTY)
    typestore.register(get_types_from_msg(schema_text(type_name), type_name))
    assert typestore.hash_rihs01(type_name) == type_hash(type_name)


def test_unknown_package_names_the_remedy():
    """A type whose package is not installed is one sentence that says to build."""
    with pytest.raises(RecordingError, match="no_such_package/msg/Thing was not found: build the workspace"):
        schema_text("no_such_package/msg/Thing")


def test_unknown_message_of_a_known_package():
    """A message that its package does not have is named."""
    with pytest.raises(RecordingError, match="std_msgs has no message Thing"):
        schema_text("std_msgs/msg/Thing")
