# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How often the right physical effect is named when one is hidden in data of a simulator that is not the model."""
