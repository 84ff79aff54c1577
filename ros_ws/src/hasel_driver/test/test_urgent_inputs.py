"""What comes by topic reaches the driver whole."""

import math
import time

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

import rclpy
from hasel_driver.testing.ros_client import RosClient
from hasel_driver.urgent_inputs import UrgentInputs

MANY = 50


@pytest.fixture
def ros():
    """A client of the test's own: if the test is repeated, nothing of the failed attempt is left."""
    client = RosClient()
    yield client
    client.close()


@pytest.fixture
def inputs():
    """Urgent inputs, held up by everything they tell, and what they have told."""
    told = {"commands": [], "stops": []}

    def take(kind: str, value) -> None:
        time.sleep(0.002)
        told[kind].append(value)

    rclpy.init()
    inputs = UrgentInputs(
        "/hasel",
        lambda: ["/hasel/arm"],
        lambda _publisher, _name, voltage_v, _age_s: take("commands", voltage_v),
        lambda stop, _who: take("stops", stop),
        lambda: None,
    )
    yield told
    inputs.close()
    rclpy.try_shutdown()


def test_every_watch_runs_on_a_steady_clock(tmp_path):
    """Neither simulated time nor a step of the system's clock holds up a timer of the node or of its inputs."""
    from hasel_driver.driver_node import DriverNode
    from rclpy.clock import ClockType
    from rclpy.parameter import Parameter

    rclpy.init()
    history = Parameter("history_file", value=str(tmp_path / "history.jsonl"))
    node = DriverNode(parameter_overrides=[history])
    try:
        timers = [*node.timers, *node._inputs._node.timers]
        assert len(timers) == 4
        assert {timer.clock.clock_type for timer in timers} == {ClockType.STEADY_TIME}
    finally:
        node.leave()
        node.destroy_node()
        rclpy.try_shutdown()


def greet_until_heard(ros, commands: list) -> None:
    """Until the two ends know each other, and no greeting is under way any more: each has its own voltage."""
    for greeting in range(1, 300):
        ros.command((float(greeting), 0.0))
        time.sleep(0.1)
        if commands:
            ros.wait(lambda last=greeting: commands[-1][0] == last)
            break
    else:
        known = ros.commands.get_subscription_count()
        pytest.fail(f"no greeting was heard within 30 s; the publisher knows of {known} subscriptions")
    commands.clear()


def test_later_commands_do_not_push_out_a_nan(ros, inputs):
    """Commands that come faster than they are taken are all seen, so that none that is not a number is missed."""
    greet_until_heard(ros, inputs["commands"])
    for _ in range(MANY):
        ros.command((1000.0, math.nan))
        ros.command((1000.0, 0.0))
    ros.wait(lambda: len(inputs["commands"]) == 2 * MANY)
    assert sum(math.isnan(voltage) for command in inputs["commands"] for voltage in command) == MANY


def test_a_stop_that_is_taken_back_at_once_is_heard(ros, inputs):
    """True is told although false follows immediately."""
    ros.emergency_stop_topic(False)
    ros.wait(lambda: inputs["stops"] == [False])
    for index in range(2 * MANY):
        ros.emergency_stop_topic(index % 2 == 0)
        time.sleep(5e-4)  # this publisher, as is usual for a latched topic, keeps the last message only
    ros.wait(lambda: len(inputs["stops"]) == 2 * MANY + 1)
    assert sum(inputs["stops"]) == MANY
    ros.drop_emergency_stop_topic()
