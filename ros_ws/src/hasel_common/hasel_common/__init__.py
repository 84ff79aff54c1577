# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What every package needs around its own work: commands, nodes, parameters, topics and provenance."""

from hasel_common.provenance import lazy_version

__getattr__ = lazy_version(__name__)
