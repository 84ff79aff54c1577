# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Batches for the lanes of several processes."""

import pytest
from hasel_sim.parallel import side_by_side
from hasel_sim.simd import LANES


@pytest.mark.parametrize("count", range(14))
def test_every_case_is_once_in_a_batch_and_alone_whatever_the_share(count):
    """The loops for one lane round otherwise than the others."""
    cases = list(range(count))
    alone = set()
    for share in (1, 2, 3, 4, 20):
        batches = side_by_side(cases, share)
        assert [case for batch in batches for case in batch] == cases
        assert all(1 <= len(batch) <= LANES[-1] for batch in batches)
        alone.add(tuple(batch[0] for batch in batches if len(batch) == 1))
    assert len(alone) == 1


def test_processes_share_the_cases():
    """Two of them, of eight cases and of four."""
    assert [len(batch) for batch in side_by_side(range(8), 4)] == [4, 4]
    assert [len(batch) for batch in side_by_side(range(4), 2)] == [2, 2]
