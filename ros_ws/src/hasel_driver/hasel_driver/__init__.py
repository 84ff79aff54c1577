# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""High-voltage supply on a serial port: protocol, limits, watchdog, waveforms, virtual supply, ROS 2 node."""

from hasel_common.provenance import lazy_version

__getattr__ = lazy_version(__name__)
