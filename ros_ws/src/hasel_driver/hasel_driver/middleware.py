"""Keeps the driver to its machine, and the ROS middleware from holding it up.

Over shared memory Fast DDS may wait 333 ms when another node comes (Fast-DDS issue 6535), and rclpy lets no other
thread run meanwhile: longer than the board's heartbeat timeout. So the driver's process talks over UDP. And what is on
the network may command what it discovers: only this machine is discovered unless the user says otherwise.
"""

import os
from collections.abc import MutableMapping
from pathlib import Path

from rclpy.utilities import get_rmw_implementation_identifier

RANGE, PROFILES = "ROS_AUTOMATIC_DISCOVERY_RANGE", "FASTRTPS_DEFAULT_PROFILES_FILE"
LOCALHOST_ONLY, PEERS = (
    "ROS_LOCALHOST_ONLY",
    "ROS_STATIC_PEERS",
)  # the former is older, and goes before the range
LOOPBACK = Path(__file__).with_name("loopback.xml")


def prepare(environment: MutableMapping[str, str] = os.environ) -> None:
    """To be called before `rclpy.init`; a user's own range, peers, profiles or transports stay, unless empty."""
    if not any(environment.get(name, "").strip() for name in (RANGE, LOCALHOST_ONLY, PEERS)):
        environment[RANGE] = "LOCALHOST"
    if "fastrtps" not in get_rmw_implementation_identifier() or PROFILES in environment:
        return
    if _this_machine_only(environment) and LOOPBACK.is_file():
        # There rmw_fastrtps insists on shared memory: give Fast DDS the same range in its own words.
        environment.pop(LOCALHOST_ONLY, None)
        environment.update({RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)})
    else:
        environment.setdefault("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")


def reach(environment: MutableMapping[str, str] = os.environ) -> str:
    """Who can command, in words."""
    if _this_machine_only(environment) or environment.get(PROFILES) == str(LOOPBACK):
        return "this machine only"
    return "EVERY machine that discovers this one: see docs/how_to/network.md"


def _this_machine_only(environment: MutableMapping[str, str]) -> bool:
    only = environment.get(LOCALHOST_ONLY, "").strip().lower()
    if only:
        return only in ("1", "true")
    chosen = environment.get(RANGE, "").strip().upper()
    return chosen == "OFF" or (chosen == "LOCALHOST" and not environment.get(PEERS))
