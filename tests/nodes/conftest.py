# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A ROS domain of its own for every test, and a listener in it."""

import itertools
import os

import pytest

from tests.nodes.listener import Listener

_NUMBERS = itertools.count(37)


@pytest.fixture
def domain() -> int:
    """Below 102, where the ports of a domain do not collide with those that the system hands out."""
    return 1 + (os.getpid() + next(_NUMBERS)) % 100


@pytest.fixture
def environment(domain) -> dict[str, str]:
    """Variables for processes of this domain, which stays on this machine."""
    return {"ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}


@pytest.fixture
def listener(domain):
    """A node that hears everything."""
    listener = Listener(domain)
    yield listener
    listener.close()
