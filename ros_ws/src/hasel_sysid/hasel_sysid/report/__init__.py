# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One self-contained HTML page about a comparison, a fit or an improvement."""
