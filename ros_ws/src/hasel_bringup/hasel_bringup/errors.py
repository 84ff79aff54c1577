# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What can go wrong when the stack is brought up; every message is one sentence with a next step."""


class BringupError(Exception):
    """Something that must be there is not."""
