# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What driver and board know in common: the lines on the wire, states, faults, limits, waveforms, calibration."""
