# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The shipped configurations fit the nodes that take them, and each entry in /diagnostics falls to one part."""

from pathlib import Path

import pytest
import yaml
from hasel_common.diagnostics import Part
from hasel_driver.nodes.parameters import PARAMETERS as DRIVER
from hasel_sim.live.live_simulator import live_model
from hasel_sim.live.simulator_node import PARAMETERS as SIMULATOR
from hasel_sysid.live.sysid_node import PARAMETERS as SYSID
from hasel_tracker.tracker_parameters import PARAMETERS as TRACKER

FOLDER = Path(__file__).resolve().parents[1] / "config"
TABLES = {
    "hasel_driver": DRIVER,
    "hasel_tracker": TRACKER,
    "hasel_simulator": SIMULATOR,
    "hasel_sysid": SYSID,
}
ENTRIES = [
    (file.name, node.removeprefix("/**/"), content["ros__parameters"])
    for file in sorted(set(FOLDER.glob("*.yaml")) - {FOLDER / "diagnostics.yaml"})
    for node, content in yaml.safe_load(file.read_text()).items()
]
DIAGNOSTICS = yaml.safe_load((FOLDER / "diagnostics.yaml").read_text())["analyzers"]["ros__parameters"]
BRANCHES = {name: branch for name, branch in DIAGNOSTICS.items() if isinstance(branch, dict)}
NODES = {
    Part.SUPPLY: ("hasel_driver", "supply"),
    Part.TRACKING: ("hasel_tracker", "camera"),
    Part.SIMULATION: ("hasel_simulator", "simulator"),
    Part.IDENTIFICATION: ("hasel_sysid", "identification"),
    Part.NODES: ("lifecycle_manager", "lifecycle"),
}
"""By part: the node that says it, and the branch that waits for it."""


@pytest.mark.parametrize(
    ("file", "node", "values"), ENTRIES, ids=lambda part: part if isinstance(part, str) else ""
)
def test_every_value_has_the_type_and_range_of_its_parameter(file, node, values):
    """ROS ignores an unknown parameter silently, so that a slip of the pen would not be noticed."""
    table = {parameter.name: parameter for parameter in TABLES[node]}
    for name, value in values.items():
        assert name in table, f"{file}: {node} has no parameter {name}"
        assert type(value) is type(table[name].default)
        if table[name].low is not None:
            assert table[name].low <= value <= table[name].high


@pytest.mark.parametrize(("file", "node", "values"), [e for e in ENTRIES if "model" in e[2]])
def test_every_model_can_be_loaded(file, node, values):
    """The names are those of models that come with the simulator."""
    assert live_model(values["model"])[0].name == values["model"]


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
