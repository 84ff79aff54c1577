"""The shipped configurations fit the nodes that take them."""

from pathlib import Path

import pytest
import yaml
from hasel_driver.nodes.parameters import PARAMETERS as DRIVER
from hasel_sim.live.live_model import live_model
from hasel_sim.simulator_node import PARAMETERS as SIMULATOR
from hasel_sysid.sysid_node import PARAMETERS as SYSID
from hasel_tracker.tracker_parameters import PARAMETERS as TRACKER

FOLDER = Path(__file__).resolve().parents[2] / "config"
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
