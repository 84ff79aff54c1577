# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Settings of every test: a ROS domain of this process on this machine only, one thread for linear algebra."""

import os

os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
if "PYTEST_XDIST_WORKER" in os.environ or "ROS_DOMAIN_ID" not in os.environ:  # a worker inherits its parent's
    os.environ["ROS_DOMAIN_ID"] = str(1 + os.getpid() % 100)
# matrices are small here: further threads wait for each other, several times as long as they work
os.environ.setdefault("OMP_NUM_THREADS", "1")
