"""The driver's process does without shared memory, and does not reach further than it is allowed to."""

from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

from hasel_driver import middleware
from hasel_driver.middleware import LOOPBACK, PROFILES, RANGE, avoid_shared_memory

TRANSPORTS = "FASTDDS_BUILTIN_TRANSPORTS"
STANDBY, LOOPBACK_ADDRESS = 0, "0100007F"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ({}, {TRANSPORTS: "UDPv4"}),
        ({RANGE: "SUBNET"}, {RANGE: "SUBNET", TRANSPORTS: "UDPv4"}),
        ({RANGE: "LOCALHOST"}, {RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)}),
        ({TRANSPORTS: "LARGE_DATA"}, {TRANSPORTS: "LARGE_DATA"}),
        ({RANGE: "LOCALHOST", PROFILES: "mine.xml"}, {RANGE: "LOCALHOST", PROFILES: "mine.xml"}),
    ],
)
def test_leaves_what_the_user_has_set(monkeypatch, before, after):
    """UDP only, within the same range; profiles and transports of the user's own stay."""
    monkeypatch.setattr(middleware, "get_rmw_implementation_identifier", lambda: "rmw_fastrtps_cpp")
    environment = dict(before)
    avoid_shared_memory(environment)
    assert environment == after


def test_leaves_other_middleware_alone(monkeypatch):
    """The settings are Fast DDS's."""
    monkeypatch.setattr(middleware, "get_rmw_implementation_identifier", lambda: "rmw_cyclonedds_cpp")
    environment = {RANGE: "LOCALHOST"}
    avoid_shared_memory(environment)
    assert environment == {RANGE: "LOCALHOST"}


def udp_addresses(process: int) -> set[str]:
    """Local addresses, in hexadecimal, of a process's UDP sockets."""
    links = [str(link.readlink()) for link in Path(f"/proc/{process}/fd").iterdir() if link.is_symlink()]
    sockets = {link[len("socket:[") : -1] for link in links if link.startswith("socket:[")}
    rows = [line.split() for line in Path("/proc/net/udp").read_text().splitlines()[1:]]
    return {row[1].split(":")[0] for row in rows if row[9] in sockets}


def test_within_this_machine_the_driver_listens_on_loopback_only(virtual_rig, start_driver, ros):
    """The tests run with the range LOCALHOST: no socket hears anything else, and no shared memory is mapped."""
    if "fastrtps" not in middleware.get_rmw_implementation_identifier():
        pytest.skip("the middleware is not Fast DDS")
    driver = start_driver(virtual_rig.port)
    ros.await_mode(STANDBY)
    assert udp_addresses(driver.process.pid) == {LOOPBACK_ADDRESS}
    assert "/dev/shm/fastrtps_port" not in Path(f"/proc/{driver.process.pid}/maps").read_text()
