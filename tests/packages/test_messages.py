# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import re
from pathlib import Path

import pytest
from rosidl_adapter.parser import (
    parse_action_string,
    parse_message_string,
    parse_service_string,
)

FOLDER = Path(__file__).resolve().parents[2] / "ros_ws" / "src" / "hasel_interfaces"
FILES = sorted(path for kind in ("msg", "srv", "action") for path in (FOLDER / kind).iterdir())
NUMBER = re.compile(
    r"^(?P<type>float\d+|u?int\d+)(?P<array>\[(?P<size>\d*)\])? (?P<name>[a-z]\w*)(?P<rest>.*)$"
)
UNIT = re.compile(r"# \[(1|V|A|s|m|px|rad|Hz|V/s|frames|unit|the SI unit [^]]*)\]")
CHOICE = re.compile(r"# .*[A-Z]{4,}")
ABBREVIATIONS = {
    "ang", "avg", "cmd", "cnt", "cur", "curr", "deg", "diff", "dir", "err", "est", "freq", "idx", "mae", "max",
    "meas", "min", "msg", "num", "param", "params", "pos", "prob", "pub", "ref", "rms", "sig", "sim", "std",
    "sub", "temp", "tmp", "val", "var", "vel", "volt", "volts",
}  # fmt: skip
each_file = pytest.mark.parametrize("file", FILES, ids=lambda path: path.name)


def fields(file: Path) -> list[re.Match]:
    """The numeric fields of an interface; constants and fields of other types are left out."""
    lines = file.read_text(encoding="utf-8").splitlines()
    return [match for line in lines if (match := NUMBER.match(line))]


@each_file
def test_every_number_has_its_unit_or_its_constants(file):
    """A comment says [unit] of a float and of a count, or which constants an integer takes."""
    bare = []
    for field in fields(file):
        choice = not field["type"].startswith("float") and CHOICE.search(field["rest"])
        if not (UNIT.search(field["rest"]) or choice):
            bare.append(field[0])
    assert bare == []


@each_file
def test_numbers_of_muscles_and_markers_are_free(file):
    """No array of numbers has a fixed size but the interlock's two contacts."""
    fixed = [field["name"] for field in fields(file) if field["size"]]
    assert fixed == (["interlock"] if file.name == "SupplyState.msg" else [])


@each_file
def test_names_are_words(file):
    """No field's name holds an abbreviation; a unit at the end of a name is none."""
    names = re.findall(r"^[\w/]+(?:\[\d*\])? ([a-z]\w*)", file.read_text(encoding="utf-8"), re.MULTILINE)
    assert [name for name in names if ABBREVIATIONS & set(name.split("_"))] == []


@each_file
def test_definition_is_valid(file):
    """The parser that generates the code takes it."""
    parse = {".msg": parse_message_string, ".srv": parse_service_string, ".action": parse_action_string}
    assert parse[file.suffix]("hasel_interfaces", file.stem, file.read_text(encoding="utf-8"))
