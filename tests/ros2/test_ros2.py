# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bin/ros2` against a node that offers one of everything, on a ROS domain of its own."""

import os
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path

import pytest
import rclpy
import yaml
from hasel_interfaces.action import RunExperiment
from hasel_interfaces.msg import Actuation, RunningError
from rclpy.action import ActionServer
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_srvs.srv import SetBool

ROOT = Path(__file__).resolve().parents[2]
DOMAIN = 1 + (os.getpid() + 61) % 100
UNSOURCED = {
    "PATH": "/usr/bin:/bin",
    "HOME": os.environ.get("HOME", "/"),
    "ROS_DOMAIN_ID": str(DOMAIN),
    "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    "PYTHONUNBUFFERED": "1",
}
pytestmark = pytest.mark.skipif(
    shutil.which("ros2") is not None, reason="ROS 2 is installed: its own ros2 answers"
)


class Rig:
    """Hears /hasel/command, says /hasel/error, has a service, an action and a parameter."""

    def __init__(self, context: Context) -> None:
        self.node = rclpy.create_node("rig", namespace="/test", context=context)
        self.commands: list[Actuation] = []
        self.node.declare_parameter("rate", 2.0)
        self.node.create_subscription(Actuation, "/hasel/command", self.commands.append, 10)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.errors = self.node.create_publisher(RunningError, "/hasel/error", latched)
        self.errors.publish(RunningError(difference=0.25, count=7))
        self.ticks = self.node.create_publisher(Actuation, "/tick", 10)
        self.node.create_timer(0.05, lambda: self.ticks.publish(Actuation()))
        self.node.create_service(SetBool, "/hasel/say", self._say)
        self.action = ActionServer(self.node, RunExperiment, "/hasel/run_experiment", self._run)

    def _say(self, request, response):
        response.success, response.message = request.data, "said"
        return response

    def _run(self, goal):
        goal.publish_feedback(RunExperiment.Feedback(progress=0.5))
        goal.succeed()
        return RunExperiment.Result(success=True, recording=f"run_{goal.request.voltage:g}.mcap")


@pytest.fixture(scope="module")
def rig():
    """The node, spun in a thread."""
    context = Context()
    before = os.environ.get("ROS_AUTOMATIC_DISCOVERY_RANGE")
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    rclpy.init(context=context, domain_id=DOMAIN)
    rig = Rig(context)
    executor = MultiThreadedExecutor(context=context)
    executor.add_node(rig.node)
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    yield rig
    executor.shutdown()
    thread.join(timeout=20)
    rig.action.destroy()
    rig.node.destroy_node()
    rclpy.try_shutdown(context=context)
    if before is None:
        del os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"]
    else:
        os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = before


def ros2(*arguments: str, code: int = 0) -> str:
    """What `bin/ros2` prints, with nothing sourced."""
    done = subprocess.run(
        [ROOT / "bin" / "ros2", *arguments],
        env=UNSOURCED,
        capture_output=True,
        text=True,
        check=False,
        timeout=90,
    )
    assert done.returncode == code, done.stdout + done.stderr
    assert "Traceback" not in done.stderr
    return done.stdout if code == 0 else done.stderr


def assert_listed(line: str, *arguments: str) -> None:
    """A busy machine may find the others late."""
    end = time.monotonic() + 60
    while line not in ros2(*arguments).splitlines():
        assert time.monotonic() < end, f"{line} was not listed"


def test_what_is_there_is_listed(rig):
    """Topics, services and actions with their types, and nodes, as `ros2` writes them."""
    assert_listed("/hasel/error [hasel_interfaces/msg/RunningError]", "topic", "list", "-t")
    assert_listed("/hasel/say [std_srvs/srv/SetBool]", "service", "list", "-t")
    assert_listed("/hasel/run_experiment [hasel_interfaces/action/RunExperiment]", "action", "list", "-t")
    assert_listed("/test/rig", "node", "list")


def test_a_latched_message_is_echoed(rig):
    """Whoever comes late gets the last one, as YAML; one field of it when asked."""
    heard = yaml.safe_load(ros2("topic", "echo", "--once", "/hasel/error").removesuffix("---\n"))
    assert (heard["difference"], heard["count"], heard["header"]["stamp"]["sec"]) == (0.25, 7, 0)
    assert ros2("topic", "echo", "--once", "/hasel/error", "--field", "count") == "7\n---\n"


def test_a_message_is_published(rig):
    """Whole numbers become floats where the field is one."""
    ros2("topic", "pub", "--once", "/hasel/command", "hasel_interfaces/msg/Actuation", "{voltage: [4000, 0]}")
    assert rig.commands[-1].voltage.tolist() == [4000.0, 0.0]


def test_the_rate_of_a_topic_is_told_until_ctrl_c(rig):
    """A timer of 20 Hz."""
    process = subprocess.Popen(
        [ROOT / "bin" / "ros2", "topic", "hz", "/tick"], env=UNSOURCED, stdout=subprocess.PIPE, text=True
    )
    try:
        said = next(line for line in process.stdout if line.startswith("average rate"))
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=60) == 130
    finally:
        process.kill()
    assert 2.0 < float(said.split()[-1]) < 40.0


def test_a_service_is_called(rig):
    """Request from YAML, answer as YAML."""
    said = ros2("service", "call", "/hasel/say", "std_srvs/srv/SetBool", "{data: true}")
    assert yaml.safe_load(said.partition("response:\n")[2]) == {"success": True, "message": "said"}


def test_a_goal_is_sent_with_feedback(rig):
    """Feedback, result and status."""
    said = ros2(
        "action",
        "send_goal",
        "--feedback",
        "/hasel/run_experiment",
        "hasel_interfaces/action/RunExperiment",
        "{voltage: 4000, frequency: 2, periods: 3}",
    )
    assert "Feedback:\nprogress: 0.5\n" in said
    assert "recording: run_4000.mcap" in said
    assert "Goal finished with status: SUCCEEDED" in said


def test_a_parameter_is_read_and_set(rig):
    """By the node's full name."""
    ros2("param", "set", "/test/rig", "rate", "5")
    assert rig.node.get_parameter("rate").value == 5.0
    assert ros2("param", "get", "/test/rig", "rate") == "Value is: 5.0\n"
    assert "  rate\n" in ros2("param", "list", "/test/rig")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("topic", "echo", "/hasel/eror"), "did you mean /hasel/error?"),
        (("topic", "pub", "/x", "hasel_interfaces/msg/Actuaton"), "There is no msg"),
        (("service", "call", "/hasel/say", "std_srvs/srv/SetBool", "{date: true}"), "expected one of data"),
        (("param", "get", "/test/rig", "speed"), "has no parameter 'speed'"),
    ],
)
def test_a_slip_of_the_pen_gets_one_sentence(rig, arguments, words):
    """With what was expected."""
    assert words in ros2(*arguments, code=1)


def test_run_starts_an_executable():
    """As bin/ros2-run does."""
    assert ros2("run", "hasel_recording", "info", "--help").startswith("usage: info")


def test_an_installed_ros2_is_asked_instead(tmp_path):
    """With all arguments, and its exit code is ours."""
    real = tmp_path / "ros2"
    real.write_text('#!/bin/sh\necho "real: $*"\nexit 4\n')
    real.chmod(0o755)
    environment = UNSOURCED | {"PATH": f"{ROOT / 'bin'}:{tmp_path}:/usr/bin:/bin"}
    done = subprocess.run(
        ["ros2", "topic", "list"], env=environment, capture_output=True, text=True, check=False, timeout=60
    )
    assert (done.stdout, done.returncode) == ("real: topic list\n", 4)
