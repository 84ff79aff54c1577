"""Supplies to test against, the virtual one and the firmware in simavr, and drivers on them."""

import shutil
import subprocess
import time
from pathlib import Path

import pytest
from _pytest.runner import runtestprotocol
from hasel_driver.testing.bench import Bench
from hasel_driver.testing.conversation import Conversation
from hasel_driver.testing.punctuality import Punctuality
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Rig

FIRMWARE = Path(__file__).parents[1] / "firmware"
NEEDED_FILES = {
    "arduino-core-avr": "/usr/share/arduino/hardware/arduino/avr/cores/arduino/Arduino.h",
    "avr-libc": "/usr/lib/avr/include/avr/io.h",
    "libsimavr-dev": "/usr/include/simavr/sim_avr.h",
}
NEEDED_PROGRAMS = {"gcc-avr": "avr-g++", "gcc": "cc", "make": "make"}
ATTEMPTS = 3
PUNCTUALITY = Punctuality()


def pytest_runtest_protocol(item, nextitem):
    """Repeat a failed test against the clock if the machine itself was late meanwhile, and only then."""
    if not {"rig", "virtual_rig", "firmware_rig", "shared_rig"} & set(item.fixturenames):
        return None
    item.ihook.pytest_runtest_logstart(nodeid=item.nodeid, location=item.location)
    for attempt in range(1, ATTEMPTS + 1):
        began_s = time.monotonic()
        reports = runtestprotocol(item, nextitem=nextitem, log=False)
        failed = any(report.failed for report in reports)
        if not failed or attempt == ATTEMPTS or not PUNCTUALITY.worst_since(began_s):
            break
        item._initrequest()
    for report in reports:
        item.ihook.pytest_runtest_logreport(report=report)
    item.ihook.pytest_runtest_logfinish(nodeid=item.nodeid, location=item.location)
    return True


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


@pytest.fixture(scope="module", params=["virtual", "firmware"])
def rig_command(request) -> list[str]:
    """Command line of each kind of supply."""
    return VIRTUAL_SUPPLY if request.param == "virtual" else request.getfixturevalue("firmware_command")


@pytest.fixture
def rig(rig_command):
    """A supply of each kind."""
    rig = Rig(rig_command)
    yield rig
    rig.close()


@pytest.fixture
def virtual_rig():
    """A virtual supply."""
    rig = Rig(VIRTUAL_SUPPLY)
    yield rig
    rig.close()


@pytest.fixture
def firmware_rig(firmware_command):
    """The firmware in simavr."""
    rig = Rig(firmware_command)
    yield rig
    rig.close()


@pytest.fixture
def bench(rig):
    """A supply of each kind with the driver's thread on it."""
    bench = Bench(rig)
    yield bench
    bench.close()


@pytest.fixture
def converse():
    """Opens a conversation with a board that has just booted."""
    begun = []

    def begin(rig: Rig) -> Conversation:
        begun.append(Conversation(rig.port))
        return begun[-1]

    yield begin
    for conversation in begun:
        conversation.close()


@pytest.fixture
def board(rig, converse) -> Conversation:
    """A conversation with a board of each kind."""
    return converse(rig)


@pytest.fixture(scope="session")
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
    from hasel_driver.testing.driver_process import DriverProcess

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
    rig = Rig(rig_command)
    yield rig
    rig.close()


@pytest.fixture(scope="module")
def shared_process(ros, shared_rig):
    """A node for all of a module's tests."""
    from hasel_driver.testing.driver_process import DriverProcess

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
