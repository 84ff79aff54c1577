"""Keeps the ROS middleware from holding up the driver.

Over shared memory Fast DDS may wait 333 ms when another node comes (Fast-DDS issue 6535), and rclpy lets no other
thread run meanwhile: longer than the board's heartbeat timeout. So the driver's process talks over UDP.
"""

import os
from collections.abc import MutableMapping
from pathlib import Path

from rclpy.utilities import get_rmw_implementation_identifier

RANGE, PROFILES = "ROS_AUTOMATIC_DISCOVERY_RANGE", "FASTRTPS_DEFAULT_PROFILES_FILE"
LOOPBACK = Path(__file__).with_name("loopback.xml")


def avoid_shared_memory(environment: MutableMapping[str, str] = os.environ) -> None:
    """To be called before `rclpy.init`; a user's own profiles or transports stay, and so does other middleware."""
    if "fastrtps" not in get_rmw_implementation_identifier() or PROFILES in environment:
        return
    if environment.get(RANGE) == "LOCALHOST" and LOOPBACK.is_file():
        # There rmw_fastrtps insists on shared memory: give Fast DDS the same range in its own words.
        environment.update({RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)})
    else:
        environment.setdefault("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
