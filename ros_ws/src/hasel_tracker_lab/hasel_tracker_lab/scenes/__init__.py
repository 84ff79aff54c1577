# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Pictures of a laboratory, drawn apart from `render`: what the tracker must not be fooled by."""
