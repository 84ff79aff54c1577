# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The launch files describe nodes that exist."""

import importlib.util
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_prefix

pytest.importorskip("launch_ros", reason="launch and launch_ros come with ROS 2 from apt, not as wheels")

FILES = sorted((Path(__file__).resolve().parents[1] / "launch").glob("*.launch.py"))


def nodes_of(file: Path, **given: str) -> list:
    """What a launch file starts with these arguments and the defaults of the others."""
    from launch import LaunchContext
    from launch.actions import DeclareLaunchArgument, OpaqueFunction
    from launch_ros.actions import Node

    specification = importlib.util.spec_from_file_location("launch_file", file)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    context = LaunchContext()
    context.launch_configurations.update(given)
    entities = module.generate_launch_description().entities
    for entity in entities:
        if isinstance(entity, DeclareLaunchArgument):
            entity.execute(context)
    made = [
        each for entity in entities if isinstance(entity, OpaqueFunction) for each in entity.execute(context)
    ]
    return [each for each in made if isinstance(each, Node)]


@pytest.mark.parametrize("given", [{}, {"virtual": "true"}], ids=["plain", "virtual"])
@pytest.mark.parametrize("file", FILES, ids=lambda path: path.name)
def test_every_node_is_an_executable_of_the_workspace(file, given):
    """The description loads, and what it starts is installed and stands under its own name in the log."""
    nodes = nodes_of(file, recording="run.mcap", **given)
    assert nodes
    for node in nodes:
        package, executable = node.node_package, node.node_executable
        assert (Path(get_package_prefix(package)) / "lib" / package / executable).is_file()
