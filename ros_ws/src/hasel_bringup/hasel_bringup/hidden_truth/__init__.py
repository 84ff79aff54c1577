# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The simulated swimmer that plays the measured one: other mesh, time step and muscles, and effects nobody is told."""
