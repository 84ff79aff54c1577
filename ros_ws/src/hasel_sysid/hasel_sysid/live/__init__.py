# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The node `sysid`: the error while it is heard, and the fit and the diagnosis that its services give."""
