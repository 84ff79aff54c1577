"""Tracker settings as a ROS 2 parameter file, read by the node and by the commands alike."""

from dataclasses import asdict, fields
from pathlib import Path
from typing import Any

import yaml
from hasel_common.names import nearest

from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.colour_gate import ColourRange
from hasel_tracker.tracking.tracker_settings import TrackerSettings

COLOUR_KEYS = tuple(each.name for each in fields(ColourRange))
SEARCH_KEYS = tuple(each.name for each in fields(TrackerSettings) if each.name != "colour")


def settings_from(values: dict[str, Any]) -> TrackerSettings:
    """Settings from flat names such as `hue_low` or `region_px`; what is not named keeps its default."""
    colour = {key: values[key] for key in COLOUR_KEYS if key in values}
    search = {key: values[key] for key in SEARCH_KEYS if key in values}
    try:
        return TrackerSettings(colour=ColourRange(**colour), **search)
    except TypeError as error:
        raise TrackerError(
            f"A tracker setting has a value of the wrong kind ({error}); give a number."
        ) from error


def flat(settings: TrackerSettings) -> dict[str, Any]:
    """Settings as flat names and values."""
    values = asdict(settings)
    return values.pop("colour") | values


def save_settings(settings: TrackerSettings, path: Path) -> None:
    """Write a parameter file for `ros2 run hasel_tracker tracker --ros-args --params-file`."""
    Path(path).write_text(yaml.safe_dump({"/**": {"ros__parameters": flat(settings)}}, sort_keys=False))


def load_settings(path: Path) -> TrackerSettings:
    """Read a parameter file; raises TrackerError for a file that is not one or a name that is not known."""
    try:
        content = yaml.safe_load(Path(path).read_text())
        values = next(iter(content.values()))["ros__parameters"]
    except (
        OSError,
        UnicodeDecodeError,
        yaml.YAMLError,
        AttributeError,
        KeyError,
        TypeError,
        StopIteration,
    ) as error:
        raise TrackerError(
            f"The settings {path} are not a ROS 2 parameter file; make one with `calibrate colour`."
        ) from error
    for key in values:
        if key not in COLOUR_KEYS + SEARCH_KEYS:
            near = nearest(key, COLOUR_KEYS + SEARCH_KEYS, similarity=0.0)
            raise TrackerError(
                f"The settings {path} have '{key}', which is not known; did you mean '{near}'?"
            )
    return settings_from(values)
