# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The process that alone talks to the supply, without ROS: what it decides, checks, drives, and tells the node."""
