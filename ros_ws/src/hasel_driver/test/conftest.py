# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Supplies to test against, the virtual one and the firmware in simavr, and drivers on them."""

import random
import shutil
import subprocess
import time
from pathlib import Path

import pytest
from hasel_driver.testing.conversation import Conversation
from hasel_driver.testing.hooks import (
    GROUNDING_TIMES_S,
    PUNCTUALITY,
    pytest_configure,  # noqa: F401
    pytest_generate_tests,  # noqa: F401
    pytest_runtest_protocol,  # noqa: F401
    pytest_terminal_summary,  # noqa: F401
)
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Bench, Rig

FIRMWARE = Path(__file__).parents[1] / "firmware"
NEEDED_FILES = {
    "arduino-core-avr": "/usr/share/arduino/hardware/arduino/avr/cores/arduino/Arduino.h",
    "avr-libc": "/usr/lib/avr/include/avr/io.h",
    "libsimavr-dev": "/usr/include/simavr/sim_avr.h",
}
NEEDED_PROGRAMS = {"gcc-avr": "avr-g++", "gcc": "cc", "make": "make"}
GROUNDED_WITHIN_S = 0.5
ALSO_ON_FIRMWARE_SLOWLY = {"test_run_experiment.py", "test_driver_node.py", "test_neighbours.py"}


@pytest.fixture(scope="session")
def firmware_build(tmp_path_factory) -> Path:
    """Folder with the compiled sketch and its simulator."""
    missing = [name for name, program in NEEDED_PROGRAMS.items() if shutil.which(program) is None]
    missing += [name for name, file in NEEDED_FILES.items() if not Path(file).exists()]
    if missing:
        pytest.skip(f"the firmware needs Debian's packages {', '.join(missing)}")
    folder = tmp_path_factory.mktemp("firmware")
    subprocess.run(["make", "-s", "-C", str(FIRMWARE), "all", "simulator", f"BUILD={folder}"], check=True)
    return folder


@pytest.fixture(scope="session")
def firmware_command(firmware_build) -> list[str]:
    """Command line of the firmware in simavr."""
    return [str(firmware_build / "simulate"), str(firmware_build / "hasel_supply.elf")]


def pytest_collection_modifyitems(items):
    """The node's own tests on the firmware, which the board's and the thread's tests try in full, are slow ones."""
    for item in items:
        parameters = getattr(item, "callspec", None)
        on_firmware = parameters is not None and parameters.params.get("rig_command") == "firmware"
        if on_firmware and item.path.name in ALSO_ON_FIRMWARE_SLOWLY:
            item.add_marker(pytest.mark.slow)


@pytest.fixture(scope="module", params=["virtual", "firmware"])
def rig_command(request) -> list[str]:
    """Command line of each kind of supply."""
    return VIRTUAL_SUPPLY if request.param == "virtual" else request.getfixturevalue("firmware_command")


@pytest.fixture
def rig(rig_command):
    """A supply of each kind."""
    rig = Rig(rig_command, PUNCTUALITY.note)
    yield rig
    rig.close()


@pytest.fixture
def virtual_rig():
    """A virtual supply."""
    rig = Rig(VIRTUAL_SUPPLY, PUNCTUALITY.note)
    yield rig
    rig.close()


@pytest.fixture
def firmware_rig(firmware_command):
    """The firmware in simavr."""
    rig = Rig(firmware_command, PUNCTUALITY.note)
    yield rig
    rig.close()


@pytest.fixture
def bench(rig):
    """A supply of each kind with the driver's thread on it."""
    bench = Bench(rig)
    yield bench
    bench.close()


@pytest.fixture
def grounded_in_time(request):
    """Asserts that a rig's output is dead within 500 ms of a moment (monotonic) [s]."""
    times_s = GROUNDING_TIMES_S.setdefault(request.node.name, [])

    def check(rig: Rig, since_s: float) -> None:
        times_s.append(rig.await_live(False) - since_s)
        assert times_s[-1] < GROUNDED_WITHIN_S

    return check


@pytest.fixture
def converse():
    """Opens a conversation with a board that has just booted."""
    begun = []

    def begin(rig: Rig, **options) -> Conversation:
        begun.append(Conversation(rig.port, **options))
        return begun[-1]

    yield begin
    for conversation in begun:
        conversation.close()


@pytest.fixture
def board(rig, converse) -> Conversation:
    """A conversation with a board of each kind."""
    return converse(rig)


@pytest.fixture(scope="module")
def ros():
    """A ROS client."""
    pytest.importorskip("rclpy", reason="ROS 2 is not there")
    pytest.importorskip("hasel_interfaces", reason="the workspace is not built")
    from hasel_driver.testing.ros_client import RosClient

    client = RosClient()
    yield client
    client.close()


@pytest.fixture
def start_driver(ros):
    """Starts driver nodes that end with the test."""
    from hasel_driver.testing.ros_client import DriverProcess

    started = []

    def start(port: str, **parameters) -> DriverProcess:
        started.append(DriverProcess(ros, port, **parameters))
        return started[-1]

    yield start
    ros.drop_emergency_stop_topic()
    for driver in started:
        driver.close()


@pytest.fixture(scope="module")
def shared_rig(rig_command):
    """A supply of each kind for all of a module's tests."""
    rig = Rig(rig_command, PUNCTUALITY.note)
    yield rig
    rig.close()


@pytest.fixture(scope="module")
def shared_process(ros, shared_rig):
    """A node for all of a module's tests."""
    from hasel_driver.testing.ros_client import DriverProcess

    driver = DriverProcess(ros, shared_rig.port)
    yield driver
    driver.close()


@pytest.fixture
def driver(shared_process, shared_rig, ros):
    """The module's node, back in STANDBY."""
    ros.drop_emergency_stop_topic()
    shared_rig.say("recover")
    shared_process.to_standby()
    shared_rig.changes.clear()
    return shared_process


@pytest.fixture
def provoke(driver, shared_rig, ros, grounded_in_time):
    """One fault while commands come: grounded in time, latched, truthful, and not brought back by more of them.

    Its `how` may return the moment (monotonic) [s] of the fault, where that is not the begin.
    """
    from hasel_driver.protocol.status import Mode

    def inject(how, code) -> None:
        driver.arm()
        with ros.commanding():
            ros.wait(lambda: shared_rig.live)
            time.sleep(random.uniform(0.0, 0.03))  # meet the commands and the heartbeat at any phase
            at_s = time.monotonic()
            at_s = how() or at_s
            grounded_in_time(shared_rig, at_s)
            ros.wait(lambda: ros.state.fault_code == code)
            assert not ros.trigger("arm").success
            time.sleep(0.1)
            assert (ros.state.mode, shared_rig.live) == (Mode.FAULT, False)
        assert ros.false_claims(shared_rig, at_s) == []

    return inject
