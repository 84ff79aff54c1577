# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which candidates a model lacks: a choice among sets of them, by one currency.

Read in this order: `likelihood` (the currency), `nothing_missing` (a test), `race` (every candidate alone), `linearise`
and `best_subsets` (the table of all sets, to first order), `search` (which of them are fitted), `cross_validation` and
`choose` (the answer).
"""
