# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
