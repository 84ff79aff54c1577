# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One muscle on its bench: compare stroke and force with the law, see where it fails, learn what is missing, add it."""

from hasel_common.provenance import lazy_version

__getattr__ = lazy_version(__name__)
