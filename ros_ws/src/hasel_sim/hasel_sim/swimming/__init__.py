# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Swimming: bodies whose shape is given, how far and how well a free body swims, sweeps, and what swims best."""
