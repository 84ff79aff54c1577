# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""For tests: supplies in software that tell the truth about their output, and users of the driver."""
