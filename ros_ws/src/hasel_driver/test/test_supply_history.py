# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults, breakdowns and leakage on disk."""

import json
import math
import random

import pytest
from hasel_driver.nodes.supply_history import SupplyHistory
from hasel_driver.protocol.faults import Fault, FaultCode
from hasel_driver.protocol.status import Mode, SupplyStatus

BREAKDOWN = Fault(FaultCode.OVERCURRENT, "test")


def status(
    time_s: float, voltage_v: float = 0.0, current_a: float = 0.0, fault: Fault | None = None
) -> SupplyStatus:
    """A driven upper muscle, or a fault."""
    mode = Mode.FAULT if fault else Mode.ACTIVE
    pair = (voltage_v, 0.0)
    return SupplyStatus(time_s, mode, fault, False, pair, pair, (current_a, math.nan))


@pytest.fixture
def path(tmp_path):
    """Where the history is kept: the folder is yet to be made."""
    return tmp_path / "new" / "history.jsonl"


def test_a_fault_is_noted_once_and_counted_for_ever(path):
    """However many states repeat it; the next driver counts on, past a line that was cut off."""
    for run in range(2):
        history = SupplyHistory(str(path), pytest.fail)
        for index in range(5):
            history.take(status(index * 0.01, fault=BREAKDOWN))
        history.take(status(1.0))
        history.take(status(1.1, fault=Fault(FaultCode.STOP)))
        assert history.summary()["breakdowns_ever"] == run + 1
        assert history.summary()["faults_ever"] == 2 * (run + 1)
        history.close()
        with path.open("a") as file:
            file.write('{"event": "fau\n')
    entries = [json.loads(line) for line in path.read_text().splitlines() if line.endswith("}")]
    assert [entry["name"] for entry in entries] == ["OVERCURRENT", "STOP"] * 2
    assert entries[0]["text"].endswith("test")


def test_leakage_is_the_current_at_a_voltage_that_stands_still(path):
    """Charging does not count, a minute lies between two notes, and the resistance is told."""
    history = SupplyHistory(str(path), pytest.fail)
    for index in range(13_000):
        charging = index < 40
        history.take(status(index * 0.01, 5000.0, 3e-4 if charging else 5e-6))
    history.close()
    entries = [json.loads(line) for line in path.read_text().splitlines()]
    assert [entry["event"] for entry in entries] == ["leakage"] * 3
    assert entries[0]["channel"] == "upper"
    assert entries[0]["resistance_ohm"] == pytest.approx(1e9, rel=0.01)


def test_the_trend_of_leakage_is_finer_than_the_monitors_step(path):
    """Reports of whole µA that scatter as the ADC's noise does: the growth by a quarter of a step is seen."""
    noise = random.Random(1)
    history = SupplyHistory(str(path), pytest.fail)
    for index in range(13_000):
        true_ua = 5.2 if index < 6_120 else 5.45
        history.take(status(index * 0.01, 5000.0, math.floor(noise.gauss(true_ua, 0.6) + 0.5) * 1e-6))
    history.close()
    entries = [json.loads(line) for line in path.read_text().splitlines()]
    assert [entry["current_a"] * 1e6 for entry in entries[1:]] == pytest.approx([5.2, 5.45], abs=0.05)
    assert [entry["reports"] for entry in entries[1:]] == pytest.approx([6000, 6000], rel=0.01)
    assert entries[1]["spread_a"] > 3e-7


def test_a_place_that_cannot_be_written_is_said_and_costs_nothing(tmp_path):
    """The supply goes on."""
    said = []
    (tmp_path / "file").write_text("")
    history = SupplyHistory(str(tmp_path / "file" / "history.jsonl"), said.append)
    history.take(status(0.0, fault=BREAKDOWN))
    history.close()
    assert "cannot be written" in said[0]
