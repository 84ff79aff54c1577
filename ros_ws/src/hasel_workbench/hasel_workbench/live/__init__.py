# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The workbench on a running rig: what is heard, the stop, runs that are asked for; arming is the driver's."""
