"""What rosbag2 (version 9, ROS 2 Jazzy) keeps beside the messages of an MCAP file."""

from dataclasses import dataclass

import yaml

from hasel_recording.message_definitions import type_hash

_INFINITE = {"sec": 9223372036, "nsec": 854775807}
_RELIABLE_QOS = {
    "history": "keep_last",
    "depth": 10,
    "reliability": "reliable",
    "durability": "volatile",
    "deadline": _INFINITE,
    "lifespan": _INFINITE,
    "liveliness": "automatic",
    "liveliness_lease_duration": _INFINITE,
    "avoid_ros_namespace_conventions": False,
}


@dataclass
class TopicCount:
    """How often a topic was recorded."""

    type_name: str
    count: int = 0


class _PlainDumper(yaml.SafeDumper):
    """Writes repeated values out instead of referring to the first one."""

    def ignore_aliases(self, data: object) -> bool:
        return True


def _yaml_text(data: object) -> str:
    return yaml.dump(data, Dumper=_PlainDumper, sort_keys=False)


def channel_metadata(type_name: str) -> dict[str, str]:
    """Return the metadata of a topic's channel: the quality of service and the hash of its type."""
    return {"offered_qos_profiles": _yaml_text([_RELIABLE_QOS]), "topic_type_hash": type_hash(type_name)}


def bag_metadata(
    file_name: str, topics: dict[str, TopicCount], first_ns: int, last_ns: int, custom: dict[str, str]
) -> dict[str, str]:
    """Return the content of the record `rosbag2`: what `metadata.yaml` says of a bag of this one file."""
    count = sum(topic.count for topic in topics.values())
    start = {"nanoseconds_since_epoch": first_ns}
    duration = {"nanoseconds": last_ns - first_ns}
    file = {"path": file_name, "starting_time": start, "duration": duration, "message_count": count}
    return {
        "serialized_metadata": _yaml_text(
            {
                "version": 9,
                "storage_identifier": "mcap",
                "duration": duration,
                "starting_time": start,
                "message_count": count,
                "topics_with_message_count": [
                    {
                        "topic_metadata": {
                            "name": name,
                            "type": topic.type_name,
                            "serialization_format": "cdr",
                            "offered_qos_profiles": [_RELIABLE_QOS],
                            "type_description_hash": type_hash(topic.type_name),
                        },
                        "message_count": topic.count,
                    }
                    for name, topic in topics.items()
                ],
                "compression_format": "",
                "compression_mode": "",
                "relative_file_paths": [file_name],
                "files": [file],
                "custom_data": custom or None,
                "ros_distro": "jazzy",
            }
        )
    }
