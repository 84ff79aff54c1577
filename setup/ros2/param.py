# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 param list|get|set|describe`."""

import argparse

import yaml
from messages import NotUnderstoodError, as_yaml
from rclpy.node import Node
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.parameter_client import AsyncParameterClient
from session import full_name, spin_until, type_of, wait_for


def add_parsers(commands) -> None:
    """Add what `ros2 param` knows."""
    for name, run, words, text in (
        ("list", list_parameters, ("node",), "parameters of a node"),
        ("get", get_parameter, ("node", "name"), "value of one"),
        ("describe", describe_parameter, ("node", "name"), "what one means"),
        ("set", set_parameter, ("node", "name", "value"), "give one a value, written as YAML"),
    ):
        command = commands.add_parser(name, help=text)
        for word in words:
            command.add_argument(word)
        command.set_defaults(run=run)


def _client(node: Node, name: str) -> AsyncParameterClient:
    def known() -> dict[str, list[str]]:
        return {f"{space.rstrip('/')}/{each}": [""] for each, space in node.get_node_names_and_namespaces()}

    wait_for(node, lambda: full_name(name) in known())
    type_of(name, known(), "node")
    client = AsyncParameterClient(node, name)
    if not spin_until(node, client.services_are_ready, 5.0):
        raise NotUnderstoodError(f"{name} does not tell its parameters.")
    return client


def _answer(node: Node, future):
    spin_until(node, future.done)
    return future.result()


def list_parameters(node: Node, options: argparse.Namespace) -> None:
    """Print the names."""
    answer = _answer(node, _client(node, options.node).list_parameters())
    print(f"{options.node}:")
    print("\n".join(f"  {name}" for name in sorted(answer.result.names)))


def _present(node: Node, client: AsyncParameterClient, options: argparse.Namespace):
    """Value of a parameter. Raises NotUnderstoodError where there is none."""
    values = _answer(node, client.get_parameters([options.name])).values
    if not values or values[0].type == Parameter.Type.NOT_SET.value:
        raise NotUnderstoodError(
            f"{options.node} has no parameter '{options.name}'; see: ros2 param list {options.node}"
        )
    return values[0]


def get_parameter(node: Node, options: argparse.Namespace) -> None:
    """Print a value."""
    value = _present(node, _client(node, options.node), options)
    print(f"Value is: {parameter_value_to_python(value)}")


def describe_parameter(node: Node, options: argparse.Namespace) -> None:
    """Print type, description and range."""
    client = _client(node, options.node)
    _present(node, client, options)
    found = _answer(node, client.describe_parameters([options.name])).descriptors[0]
    print(as_yaml(found), end="")


def set_parameter(node: Node, options: argparse.Namespace) -> None:
    """Set a value. Raises NotUnderstoodError with the node's reason where it refuses."""
    client = _client(node, options.node)
    value = yaml.safe_load(options.value)
    if _present(node, client, options).type == Parameter.Type.DOUBLE.value and isinstance(value, int):
        value = float(value)
    result = _answer(node, client.set_parameters([Parameter(options.name, value=value)])).results[0]
    if not result.successful:
        raise NotUnderstoodError(f"Setting parameter failed: {result.reason}")
    print("Set parameter successful")
