# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Parameters as a table, and what ROS is told of them."""

from contextlib import contextmanager

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

import rclpy
from hasel_common.declared_parameters import declare, descriptor, words
from hasel_common.managed_node import node_alone
from hasel_common.node_parameter import NodeParameter
from rclpy.context import Context
from rclpy.exceptions import InvalidParameterValueException
from rclpy.parameter import Parameter

RATE = NodeParameter("rate", 120.0, "of the camera", "1/s", 1, 1000, changeable=True)
METHOD = NodeParameter("method", "blobs", "how markers are found", choices=("blobs", "tags"))
NAMES = NodeParameter("names", [""], "of further effects")


@pytest.fixture
def node():
    """A node in a context of its own."""
    node = node_alone("declares")
    yield node
    node.destroy_node()
    node.context.try_shutdown()


def test_description_unit_range_and_choices_are_told():
    """As `ros2 param describe` lists them."""
    rate, method = descriptor(RATE), descriptor(METHOD)
    assert rate.description == "of the camera [1/s]"
    span = rate.floating_point_range[0]
    assert (span.from_value, span.to_value) == (1.0, 1000.0)
    assert not rate.read_only
    assert method.additional_constraints == "one of blobs, tags"
    assert method.read_only
    whole = descriptor(NodeParameter("count", 3, "of markers", "", 2, 15)).integer_range[0]
    assert (whole.from_value, whole.to_value, whole.step) == (2, 15, 1)


def test_what_is_checked_elsewhere_is_left_alone():
    """Its type and whether it may change; a range is told all the same."""
    told = descriptor(NodeParameter("limit", 6000.0, "of the supply", "V", 0, 9800), checked_elsewhere=True)
    assert told.dynamic_typing and not told.read_only
    assert told.floating_point_range[0].to_value == 9800.0


def test_ros_refuses_what_is_out_of_range(node):
    """And what may not change."""
    declare(node, [RATE, METHOD])
    rate, method = node.set_parameters([Parameter("rate", value=5000.0), Parameter("method", value="tags")])
    assert not rate.successful and not method.successful
    assert node.set_parameters([Parameter("rate", value=60.0)])[0].successful
    with pytest.raises(InvalidParameterValueException):
        declare(node, [NodeParameter("wrong", 5.0, "beyond its own range", "", 0.0, 1.0)])


def test_words_of_an_empty_list(node):
    """An empty list has no type in ROS, so it holds an empty word."""
    declare(node, [NAMES, NodeParameter("two", ["a", "b"], "of them")])
    assert words(node, "names") == ()
    assert words(node, "two") == ("a", "b")


def test_usage_tells_unit_and_range():
    """For --help."""
    assert RATE.usage == ("rate", 120.0, "of the camera [1/s, 1 to 1000]")
    assert METHOD.usage == ("method", "blobs", "how markers are found")


SOURCE = NodeParameter("source", "topic:/x", "camera, file or topic")
COUNT = NodeParameter("queue_size", 8, "of frames", "", 1, 100)
JOBS = NodeParameter("jobs", 0, "processes", "1", 0, 256)
TABLE = [RATE, METHOD, NAMES, SOURCE, COUNT, JOBS, NodeParameter("offsets", [0.0], "of channels", "V")]


def started(**given):
    """A node to which these parameters were given on the command line, declared."""
    context = Context()
    rclpy.init(context=context)
    overrides = [Parameter(name, value=value) for name, value in given.items()]
    node = rclpy.create_node("given", context=context, parameter_overrides=overrides)
    try:
        declare(node, TABLE)
        yield node
    finally:
        node.destroy_node()
        context.try_shutdown()


@pytest.mark.parametrize(
    ("name", "given", "taken"),
    [
        ("source", 0, "0"),
        ("source", 20261127, "20261127"),
        ("source", 100000.0, "100000"),
        ("source", True, "true"),
        ("rate", 30, 30.0),
        ("queue_size", 4.0, 4),
        ("names", "drag", ["drag"]),
        ("names", [1, 2], ["1", "2"]),
        ("offsets", [1, 2], [1.0, 2.0]),
    ],
)
def test_values_are_taken_as_they_are_typed(name, given, taken):
    """A whole number where a number is wanted, a number where a name is, one word for a list; later too."""
    with contextmanager(started)(**{name: given}) as node:
        value = node.get_parameter(name).value
        assert (list(value) if isinstance(taken, list) else value) == taken
        if name == "rate":
            assert node.set_parameters([Parameter("rate", value=25)])[0].successful
            assert node.get_parameter("rate").value == 25.0


@pytest.mark.parametrize(
    ("name", "given", "said"),
    [
        ("queue_size", 0, "the parameter queue_size is 0; expected a whole number from 1 to 100"),
        ("rate", "fast", "the parameter rate is 'fast'; expected a number from 1 to 1000 1/s"),
        ("jobs", 300, r"the parameter jobs is 300; expected a whole number from 0 to 256 \(processes\)"),
        ("queue_size", 2.5, "the parameter queue_size is 2.5; expected a whole number"),
        ("sorce", "x", "there is no parameter sorce: did you mean source"),
    ],
)
def test_what_does_not_fit_ends_the_node_in_a_sentence(name, given, said):
    """Out of range, of another type, or misspelt: no stack trace."""
    with pytest.raises(SystemExit, match=said), contextmanager(started)(**{name: given}):
        pass


def test_names_of_others_are_left_alone():
    """A parameter file for all nodes may hold what this one does not know."""
    with contextmanager(started)(wingspan=3.0, use_sim_time=False) as node:
        assert node.get_parameter("rate").value == 120.0
