"""The launch files describe nodes that exist."""

import importlib.util
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_prefix

pytest.importorskip("launch_ros", reason="launch and launch_ros come with ROS 2 from apt, not as wheels")

FILES = sorted((Path(__file__).resolve().parents[2] / "launch").glob("*.launch.py"))


@pytest.mark.parametrize("file", FILES, ids=lambda path: path.name)
def test_every_node_is_an_executable_of_the_workspace(file):
    """The description loads, and what it starts is installed."""
    from launch_ros.actions import Node

    specification = importlib.util.spec_from_file_location("launch_file", file)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    nodes = [entity for entity in module.generate_launch_description().entities if isinstance(entity, Node)]
    assert nodes
    for node in nodes:
        package, executable = node.node_package, node.node_executable
        if not package.startswith("hasel_"):
            continue  # from another package, which a user asks for
        assert (Path(get_package_prefix(package)) / "lib" / package / executable).is_file()
