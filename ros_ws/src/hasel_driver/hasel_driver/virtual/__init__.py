# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Supplies that exist only in software, with the same protocol and faults as real ones."""
