"""Message definitions of the installed interface packages, found through the ament index."""

import json
from functools import cache
from pathlib import Path

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from rosidl_adapter.parser import MessageSpecification, parse_message_string

from hasel_recording.errors import RecordingError

SEPARATOR = "=" * 80


def _definition_file(type_name: str, suffix: str) -> Path:
    """Return the file `share/PACKAGE/msg/TYPE.suffix` of a type such as std_msgs/msg/Header."""
    package, _, name = type_name.split("/")
    try:
        file = Path(get_package_share_directory(package)) / "msg" / f"{name}{suffix}"
    except (PackageNotFoundError, LookupError):
        raise RecordingError(
            f"The definition of {type_name} was not found: build the workspace with `make build` and source "
            "setup/environment.bash (or install/setup.bash where ROS 2 is sourced)."
        ) from None
    if not file.exists():
        raise RecordingError(f"Package {package} has no message {name}: see {file.parent} for those it has.")
    return file


@cache
def specification(type_name: str) -> MessageSpecification:
    """Return the parsed definition of a message type."""
    package, _, name = type_name.split("/")
    return parse_message_string(package, name, _definition_file(type_name, ".msg").read_text("utf-8"))


def nested_types(type_name: str) -> list[str]:
    """Return the types of the message's own fields that are messages themselves."""
    types = [field.type for field in specification(type_name).fields]
    return [f"{t.pkg_name}/msg/{t.type}" for t in types if not t.is_primitive_type()]


def has_header(type_name: str) -> bool:
    """Return whether a message of this type begins with a std_msgs/Header."""
    return "std_msgs/msg/Header" in nested_types(type_name)[:1]


@cache
def schema_text(type_name: str) -> str:
    """Return the definition followed by those of all types in it, as rosbag2 stores it (`ros2msg`)."""
    found = [type_name]
    for current in found:  # grows while it is walked
        found += [nested for nested in dict.fromkeys(nested_types(current)) if nested not in found]
    texts = [_definition_file(name, ".msg").read_text("utf-8") for name in found]
    for index, name in enumerate(found[1:], start=1):
        texts[index] = f"{SEPARATOR}\nMSG: {name.replace('/msg/', '/')}\n{texts[index]}"
    return "\n".join(texts)


@cache
def type_hash(type_name: str) -> str:
    """Return the type's REP-2016 hash, `RIHS01_…`."""
    description = json.loads(_definition_file(type_name, ".json").read_text("utf-8"))
    return next(h["hash_string"] for h in description["type_hashes"] if h["type_name"] == type_name)
