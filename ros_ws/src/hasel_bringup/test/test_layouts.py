# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The layouts for Foxglove, PlotJuggler and RViz are valid and show only what the rig publishes."""

import json
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml
from hasel_common.topics import FRAMES, SIMULATED, SWIMMER, TOPIC_TYPES

FOLDER = Path(__file__).resolve().parents[1] / "layouts"
PREVIEW = "/hasel/hasel_tracker/preview/compressed"


def check_number(topic: str, field: str) -> None:
    """That messages of the topic have this field, and that it is a number, or one of several."""
    package, _, kind = TOPIC_TYPES[topic].split("/")
    fields = getattr(import_module(f"{package}.msg"), kind).get_fields_and_field_types()
    name, index = re.fullmatch(r"(\w+)(\[\d+\])?", field).groups()
    assert name in fields, f"{topic} has no {name}, but {', '.join(fields)}"
    assert bool(index) == fields[name].startswith("sequence<"), f"{topic}: {fields[name]} {name}"
    assert re.search(r"double|float|int|boolean", fields[name])


def panels(layout: dict | str) -> Iterator[str]:
    """Names of the panels that a Foxglove layout arranges."""
    if isinstance(layout, str):
        yield layout
    else:
        assert layout["direction"] in ("row", "column")
        yield from (*panels(layout["first"]), *panels(layout["second"]))


def test_foxglove():
    """Every panel is arranged once, and every path is a number that some topic has."""
    layout = json.loads((FOLDER / "foxglove.json").read_text())
    configured = layout["configById"]
    assert sorted(panels(layout["layout"])) == sorted(configured)
    paths = [path["value"] for panel in configured.values() for path in panel.get("paths", ())]
    assert len(paths) == len(set(paths)) > 10
    for path in paths:
        check_number(*path.split("."))
    assert configured["3D!swimmer"]["topics"] == {SWIMMER: {"visible": True}}
    assert configured["3D!swimmer"]["followTf"] == FRAMES[SIMULATED]
    assert configured["Image!camera"]["imageMode"]["imageTopic"] == PREVIEW
    assert configured["DiagnosticSummary!all"]["topicToRender"] in TOPIC_TYPES


def test_plotjuggler():
    """Every curve is a number that some topic has; areas are as many as their splitter says."""
    root = ElementTree.parse(FOLDER / "plotjuggler.xml").getroot()
    curves = [curve.get("name") for curve in root.iter("curve")]
    assert len(curves) == len(set(curves)) >= 8
    for curve in curves:
        check_number(*curve.rsplit("/", 1))
    for splitter in root.iter("DockSplitter"):
        assert int(splitter.get("count")) == len(splitter) == len(splitter.get("sizes").split(";"))


def test_rviz():
    """The body in its own frame, and the camera's picture, without asking for more than the publishers promise."""
    manager = yaml.safe_load((FOLDER / "rig.rviz").read_text())["Visualization Manager"]
    shown = {d["Class"].partition("/")[2]: d["Topic"] for d in manager["Displays"] if "Topic" in d}
    assert shown["MarkerArray"]["Value"] == SWIMMER
    assert shown["Image"]["Value"] == PREVIEW
    assert {topic["Reliability Policy"] for topic in shown.values()} == {"Best Effort"}
    assert manager["Global Options"]["Fixed Frame"] == FRAMES[SIMULATED]


def test_the_preview_is_a_topic_of_the_tracker():
    """In the tracker's own namespace, compressed."""
    tracker_node = pytest.importorskip("hasel_tracker.tracker_node", reason="ROS 2 is not there")
    source = Path(tracker_node.__file__).read_text()
    assert f'"~/{PREVIEW.removeprefix("/hasel/hasel_tracker/")}"' in source
