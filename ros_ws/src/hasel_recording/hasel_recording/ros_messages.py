# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""ROS messages: their definitions, found through the ament index, and their fields as plain values."""

import json
import math
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from hasel_common.names import nearest
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
    values = message if isinstance(message, Mapping) else {name: getattr(message, name) for name in names}
    for name in values:
        if name not in names:
            hint = nearest(str(name), names) or ", ".join(names)
            raise RecordingError(f"{type_name} has no field {name!r}: did you mean {hint}?")
    missing = [name for name in names if name not in values]
    if missing:
        raise RecordingError(f"A {type_name} was given without {', '.join(missing)}: give every field.")
    return {field.name: _plain(values[field.name], field.type) for field in fields}


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


def bending_angle_message(
    sin_theta: float,
    theta: float | None = None,
    sin_theta_standard_deviation: float = math.nan,
    marker_names: Sequence[str] = (),
    pixels: np.ndarray | None = None,
    metres: np.ndarray | None = None,
    quality: Sequence[float] | None = None,
    doubt: int = 0,
) -> dict[str, Any]:
    """Return every field but the header, which the recorder makes from the stamp.

    sin_theta: NaN for a frame without an angle. theta [rad]: None takes the arcsine. pixels (y down), metres (y up):
    [m, 2] in the order of marker_names, or None. quality: [m]; None: not known.
    """
    count = len(marker_names) if pixels is not None or metres is not None else 0
    unknown = np.full((count, 2), math.nan)
    pixels = unknown if pixels is None else np.asarray(pixels, dtype=float)
    metres = unknown[:0] if metres is None else np.asarray(metres, dtype=float)
    return {
        "sin_theta": sin_theta,
        "sin_theta_standard_deviation": sin_theta_standard_deviation,
        "theta": math.asin(max(-1.0, min(1.0, sin_theta))) if theta is None else theta,
        "marker_name": list(marker_names)[:count],
        "marker_x": pixels[:, 0].tolist(),
        "marker_y": pixels[:, 1].tolist(),
        "marker_quality": [math.nan] * count if quality is None else [float(each) for each in quality],
        "marker_x_m": metres[:, 0].tolist(),
        "marker_y_m": metres[:, 1].tolist(),
        "doubt": doubt,
        "valid": math.isfinite(sin_theta),
    }
