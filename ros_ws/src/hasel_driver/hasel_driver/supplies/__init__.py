# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""High-voltage supplies at a serial port, each behind one interface."""
