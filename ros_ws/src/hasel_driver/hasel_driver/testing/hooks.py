# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Hooks for pytest: few or many rounds, repetition where the machine was late, and the times that were measured."""

import time

import pytest
from _pytest.runner import runtestprotocol

from hasel_driver.testing.rig import Punctuality

ATTEMPTS = 5
LATE_WITHIN_S = 20.0  # before a failure: what was late earlier did not cause it
MANY = 10
SUPPLIES = {"rig", "virtual_rig", "firmware_rig", "shared_rig", "loaded_rig"}
PUNCTUALITY = Punctuality()
GROUNDING_TIMES_S: dict[str, list[float]] = {}
REPEATED: list[str] = []


def pytest_configure(config: pytest.Config) -> None:
    """Explain the marker."""
    config.addinivalue_line("markers", "rounds(few, many): gives the argument `rounds`, `many` in slow tests")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """One body for the quick and the slow version of a test."""
    marker = metafunc.definition.get_closest_marker("rounds")
    if marker is not None:
        few, many = marker.args
        slow = [pytest.mark.slow, pytest.mark.timeout(900)]
        metafunc.parametrize(
            "rounds", [pytest.param(few, id="few"), pytest.param(many, id="many", marks=slow)]
        )


def pytest_runtest_protocol(item: pytest.Function, nextitem: pytest.Item | None) -> bool | None:
    """Repeat a failed test against the clock if the machine itself was late meanwhile, and only then."""
    if not SUPPLIES & set(item.fixturenames):
        return None
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    for attempt in range(1, ATTEMPTS + 1):
        began_s = time.monotonic()
        reports = runtestprotocol(item, nextitem=nextitem, log=False)
        failed = any(report.failed for report in reports)
        evidence_s = max(began_s, time.monotonic() - LATE_WITHIN_S)
        if not failed or attempt == ATTEMPTS or not PUNCTUALITY.worst_since(evidence_s):
            break
        REPEATED.append(item.name)
        item._initrequest()
    for report in reports:
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """What was measured over many rounds, and what was repeated."""
    for name, times_s in GROUNDING_TIMES_S.items():
        if len(times_s) >= MANY:
            terminalreporter.write_line(
                f"{name}: grounded {len(times_s)} times, within {1e3 * max(times_s):.0f} ms"
            )
    for name in REPEATED:
        terminalreporter.write_line(f"{name}: failed while the machine was late, and was repeated")
