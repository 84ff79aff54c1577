# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The lifecycle node: services, topics and actions in front of the safety process."""
