# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What can go wrong in identification; every message is one sentence with a next step."""


class SysidError(Exception):
    """Recordings, options or results with which identification cannot go on."""
