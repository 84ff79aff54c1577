# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The workbench: load runs, see where the model fails, try an effect by hand, watch the error fall."""

from hasel_common.provenance import lazy_version

__getattr__ = lazy_version(__name__)
