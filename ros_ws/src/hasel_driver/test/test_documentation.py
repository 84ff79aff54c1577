# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page's tables say what the code says."""

import re
from pathlib import Path

import pytest
from hasel_driver.nodes.parameters import PARAMETERS
from hasel_driver.protocol.faults import FaultCode
from hasel_driver.protocol.status import Mode
from hasel_driver.safety.supply_checks import CHECKS
from hasel_driver.virtual.virtual_board import SETTINGS

PACKAGE = Path(__file__).parents[1]
DOCS = Path(__file__).resolve().parents[4] / "docs"
PAGE = (DOCS / "how_to/high_voltage.md").read_text(encoding="utf-8")
PROTOCOL = (PACKAGE / "firmware" / "PROTOCOL.md").read_text()


def table(document: str, heading: str) -> list[list[str]]:
    """Rows of the first table under a heading, without header and rule."""
    section = document.split(f"\n## {heading}\n")[1].split("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in row.strip("|").split("|")] for row in rows[2:]]


def shown(value: object) -> str:
    """A default as the page shows it."""
    if isinstance(value, bool):
        return str(value)
    if isinstance(value, (int, float)):
        return f"{value:g}"
    if isinstance(value, list):
        return ", ".join(f"`{item}`" for item in value)
    return f"`{value}`" if value else ""


def test_every_parameter_with_default_range_unit_and_meaning():
    """The parameter table is the code's table."""
    expected = []
    for parameter in PARAMETERS:
        limits = "" if parameter.low is None else f"{parameter.low:g} to {parameter.high:g}"
        limits = limits or ", ".join(parameter.choices)
        row = [f"`{parameter.name}`", shown(parameter.default), limits, parameter.unit, parameter.description]
        expected.append(row)
    assert table(PAGE, "Parameters") == expected


def test_every_fault():
    """The fault table is the code's table."""
    expected = [[str(int(code)), code.name, code.explanation] for code in FaultCode if code]
    assert table(PAGE, "Faults") == expected


def test_every_mode():
    """The states are the message's states."""
    assert [row[0] for row in table(PAGE, "States")] == [mode.name for mode in Mode]


def test_every_fault_of_the_board_is_in_the_protocol():
    """PROTOCOL.md lists the board's faults with the codes used by the driver."""
    listed = re.findall(r"^\| ([A-Z_]+) \| (\d+) \|", PROTOCOL, re.MULTILINE)
    assert {name: int(code) for name, code in listed} == {
        code.name: int(code) for code in FaultCode if code < 100
    }


def test_every_setting_of_the_board_is_in_the_protocol():
    """Ranges and boot values in PROTOCOL.md are those of the virtual board (the firmware is tested against them)."""
    for name, (least, most, initial) in SETTINGS.items():
        assert re.search(rf"^\| {name} \| \S+ \| {least} \| {most} \| {initial} \|$", PROTOCOL, re.MULTILINE)


def test_every_executable():
    """Each console script is named."""
    scripts = re.findall(r'"(\w+) = hasel_driver', (PACKAGE / "setup.py").read_text())
    assert len(scripts) == 8
    assert all(f"`{script}`" in PAGE for script in scripts)


@pytest.mark.parametrize("heading", ["Topics", "Services and action"])
def test_every_interface_exists_with_its_type(ros, start_driver, heading):
    """Each listed topic, service and action is offered by the running node, with the listed type."""
    start_driver("/dev/no-such-port")

    def offered() -> dict[str, list[str]]:
        topics = dict(ros.node.get_topic_names_and_types())
        services = dict(ros.node.get_service_names_and_types())
        return topics | {f"service {name}": types for name, types in services.items()}

    def has(name: str, kind: str) -> bool:
        if "/action/" in kind:
            return f"{kind}_FeedbackMessage" in offered().get(f"{name}/_action/feedback", [])
        key = f"service {name}" if "/srv/" in kind else name
        return kind in offered().get(key, [])

    for row in table(PAGE, heading):
        name, kind = row[0].strip("`"), row[1].strip("`")
        ros.wait(lambda name=name, kind=kind: has(name, kind), 10.0)


def test_every_check_of_the_host():
    """The safety page lists the rows of the table of checks, with their reasons."""
    page = (DOCS / "method" / "safety.md").read_text()
    rows = table(page, "Checks")
    assert [(row[0], row[-1]) for row in rows] == [(check.code.name, check.why) for check in CHECKS]
