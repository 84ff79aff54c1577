# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The whole way from measuring to knowing what is missing, on recordings or live on a virtual rig."""
