# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Truths of another mesh that ring far off the model's frequency."""

import pytest
from hasel_benchmark.bench_far import FarCase, run_case, value_of
from hasel_sim.parallel import executor

CANDIDATES = ("payload", "soft_modulus", "linear_drag")


@pytest.fixture(scope="module")
def pool():
    """One process: these cases are small."""
    with executor(1) as serial:
        yield serial


@pytest.mark.timeout(600)
@pytest.mark.parametrize(
    ("effect", "shift", "noise"),
    [
        ("payload", -0.4, 2e-5),
        pytest.param("payload", -0.6, 3e-3, marks=pytest.mark.slow),
        pytest.param("soft_modulus", -0.25, 3e-4, marks=pytest.mark.slow),
        pytest.param("soft_modulus", 0.25, 3e-4, marks=pytest.mark.slow),
    ],
)
def test_a_beam_that_rings_far_off_shows_what_is_wrong(effect, shift, noise, pool):
    """The wrong constant is added, or in the stated group; no other is said to explain it."""
    found = run_case(FarCase(effect, shift, "beam", noise), pool, CANDIDATES)
    assert found.right and not found.sure, str(found)


def test_what_no_plausible_value_brings_about_is_no_case():
    """No mass makes a body ring faster."""
    assert value_of(FarCase("payload", 0.4, "beam", 2e-5)) is None
