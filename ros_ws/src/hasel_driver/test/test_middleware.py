# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The driver's process does without shared memory, and does not reach further than it is allowed to."""

from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

from hasel_driver.nodes import middleware
from hasel_driver.nodes.middleware import LOCALHOST_ONLY, LOOPBACK, PEERS, PROFILES, RANGE, prepare

TRANSPORTS = "FASTDDS_BUILTIN_TRANSPORTS"
STANDBY, LOOPBACK_ADDRESS = 0, "0100007F"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ({}, {RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)}),
        ({PEERS: ""}, {PEERS: "", RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)}),
        ({RANGE: " "}, {RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)}),
        ({LOCALHOST_ONLY: ""}, {RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)}),
        ({RANGE: "localhost"}, {RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)}),
        ({LOCALHOST_ONLY: "1"}, {RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)}),
        ({LOCALHOST_ONLY: "1", RANGE: "SUBNET"}, {RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)}),
        ({LOCALHOST_ONLY: "0"}, {LOCALHOST_ONLY: "0", TRANSPORTS: "UDPv4"}),
        ({PEERS: "10.0.0.2"}, {PEERS: "10.0.0.2", TRANSPORTS: "UDPv4"}),
        ({RANGE: "SUBNET"}, {RANGE: "SUBNET", TRANSPORTS: "UDPv4"}),
        ({RANGE: "LOCALHOST"}, {RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)}),
        ({RANGE: "SUBNET", TRANSPORTS: "LARGE_DATA"}, {RANGE: "SUBNET", TRANSPORTS: "LARGE_DATA"}),
        ({RANGE: "LOCALHOST", PROFILES: "mine.xml"}, {RANGE: "LOCALHOST", PROFILES: "mine.xml"}),
    ],
)
def test_leaves_what_the_user_has_set(monkeypatch, before, after):
    """UDP only, and this machine only, in every spelling; ranges, profiles and transports of the user's own stay."""
    monkeypatch.setattr(middleware, "get_rmw_implementation_identifier", lambda: "rmw_fastrtps_cpp")
    environment = dict(before)
    prepare(environment)
    assert environment == after


def test_leaves_other_middleware_alone(monkeypatch):
    """The settings are Fast DDS's."""
    monkeypatch.setattr(middleware, "get_rmw_implementation_identifier", lambda: "rmw_cyclonedds_cpp")
    environment = {RANGE: "LOCALHOST"}
    prepare(environment)
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
