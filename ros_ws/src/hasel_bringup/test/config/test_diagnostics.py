"""Each node's entry in /diagnostics falls to one part of the aggregated tree."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from builtin_interfaces.msg import Time
from hasel_driver.messages import to_diagnostics
from hasel_sim.simulator_messages import diagnostics as of_simulation
from hasel_sysid.sysid_messages import diagnostics as of_identification
from hasel_tracker.live.health_report import HealthReport
from hasel_tracker.live.tracking_statistics import Health
from hasel_tracker.node_messages import diagnostic_status

FILE = Path(__file__).resolve().parents[2] / "config" / "diagnostics.yaml"
PARTS = {
    name: part
    for name, part in yaml.safe_load(FILE.read_text())["analyzers"]["ros__parameters"].items()
    if isinstance(part, dict)
}


def entries(namespace: str) -> dict[str, str]:
    """The names that the nodes of a rig give to their entries, by part."""
    now = Time()
    nothing = Health(0, 0.0, 0.0, 0.0, np.zeros(0), 0.0)
    tracker = diagnostic_status(f"{namespace}/hasel_tracker", HealthReport(0, ""), nothing, {})
    return {
        "supply": to_diagnostics(f"{namespace}/hasel_driver", None, now, {}).status[0].name,
        "camera": tracker.name,
        "simulator": of_simulation(f"{namespace}/hasel_simulator", b"\0", "", {}, now).status[0].name,
        "identification": of_identification(f"{namespace}/hasel_sysid", "", {}, now).status[0].name,
    }


@pytest.mark.parametrize("namespace", ["hasel", "rig2"])
def test_each_entry_has_its_part(namespace):
    """In whatever namespace; nothing is left over, and no part waits for what nobody says."""
    found = {
        of: [name for name, part in PARTS.items() if any(words in entry for words in part["contains"])]
        for of, entry in entries(namespace).items()
    }
    assert found == {name: [name] for name in PARTS}


def test_all_are_of_the_general_kind_and_become_stale():
    """A part that says nothing any more is not called well."""
    for part in PARTS.values():
        assert part["type"] == "diagnostic_aggregator/GenericAnalyzer"
        assert 1.0 < part["timeout"] <= 10.0
