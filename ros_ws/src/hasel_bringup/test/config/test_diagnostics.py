"""Each node's entry in /diagnostics falls to one part of the aggregated tree."""

from pathlib import Path

import pytest
import yaml
from hasel_common.diagnostics import Part

FILE = Path(__file__).resolve().parents[2] / "config" / "diagnostics.yaml"
BRANCHES = {
    name: branch
    for name, branch in yaml.safe_load(FILE.read_text())["analyzers"]["ros__parameters"].items()
    if isinstance(branch, dict)
}
NODES = {
    Part.SUPPLY: ("hasel_driver", "supply"),
    Part.TRACKING: ("hasel_tracker", "camera"),
    Part.SIMULATION: ("hasel_simulator", "simulator"),
    Part.IDENTIFICATION: ("hasel_sysid", "identification"),
    Part.NODES: ("lifecycle_manager", "lifecycle"),
}
"""By part: the node that says it, and the branch that waits for it."""


@pytest.mark.parametrize("namespace", ["hasel", "rig2"])
def test_each_entry_has_its_branch(namespace):
    """In whatever namespace; nothing is left over, and no branch waits for what nobody says."""
    found = {
        part: [
            name
            for name, branch in BRANCHES.items()
            if any(words in f"{namespace}/{NODES[part][0]}: {part.value}" for words in branch["contains"])
        ]
        for part in Part
    }
    assert found == {part: [branch] for part, (_, branch) in NODES.items()}
    assert set(BRANCHES) == {branch for _, branch in NODES.values()}


def test_all_are_of_the_general_kind_and_become_stale():
    """A branch that says nothing any more is not called well."""
    for branch in BRANCHES.values():
        assert branch["type"] == "diagnostic_aggregator/GenericAnalyzer"
        assert 1.0 < branch["timeout"] <= 10.0
