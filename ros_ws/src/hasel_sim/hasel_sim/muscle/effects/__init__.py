# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One effect of the muscle on its bench per file; the catalogue is filled by the files being here."""
