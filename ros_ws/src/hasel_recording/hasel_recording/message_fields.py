"""ROS messages, or dicts shaped like them, as plain values that an encoder takes."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from hasel_common.names import nearest

from hasel_recording.errors import RecordingError
from hasel_recording.message_definitions import specification


def stamp(nanoseconds: int) -> dict[str, int]:
    """Return a builtin_interfaces/Time as fields; times before zero have negative seconds."""
    seconds, rest = divmod(nanoseconds, 1_000_000_000)
    return {"sec": seconds, "nanosec": rest}


def nanoseconds(time: Any) -> int:
    """Return a builtin_interfaces/Time message in nanoseconds."""
    return time.sec * 1_000_000_000 + time.nanosec


def type_of(message: Any) -> str | None:
    """Return the type of a ROS message object, such as std_msgs/msg/Header; None for a mapping."""
    if isinstance(message, Mapping):
        return None
    return f"{type(message).__module__.split('.')[0]}/msg/{type(message).__name__}"


def plain_fields(message: Any, type_name: str) -> dict[str, Any]:
    """Return a message's fields by name, nested messages as dicts and arrays as lists.

    message: a ROS message object or a mapping that gives every field. Raises RecordingError for a field that
    is missing or that the type does not have.
    """
    fields = specification(type_name).fields
    names = [field.name for field in fields]
    if isinstance(message, Mapping):
        _check_names(message, names, type_name)
        values = message
    else:
        values = {name: getattr(message, name) for name in names}
    return {field.name: _plain(values[field.name], field.type) for field in fields}


def _check_names(message: Mapping, names: list[str], type_name: str) -> None:
    for name in message:
        if name not in names:
            hint = nearest(str(name), names) or ", ".join(names)
            raise RecordingError(f"{type_name} has no field {name!r}: did you mean {hint}?")
    missing = [name for name in names if name not in message]
    if missing:
        raise RecordingError(f"A {type_name} was given without {', '.join(missing)}: give every field.")


def _plain(value: Any, field_type: Any) -> Any:
    if field_type.is_primitive_type():
        if not field_type.is_array:
            return value
        plain = np.asarray(value).tolist() if not isinstance(value, (bytes, list)) else value
        if field_type.array_size and not field_type.is_upper_bound and len(plain) != field_type.array_size:
            raise RecordingError(
                f"Found {len(plain)} values where a {field_type} is expected: give all of them."
            )
        return plain
    nested = f"{field_type.pkg_name}/msg/{field_type.type}"
    if field_type.is_array:
        return [plain_fields(item, nested) for item in value]
    return plain_fields(value, nested)
