# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The body as a solid: state, stresses, element forces and the band matrix; every array in all lanes."""
