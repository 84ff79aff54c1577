# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Soft modulus."""

import pytest


def test_the_frequency_grows_with_the_root_of_the_modulus(cantilever, damped_sine):
    """A modulus 1.44 times as high gives 1.2 times the frequency."""
    beam = cantilever()
    plain, _ = damped_sine(*beam.ring_down(1.0), beam.frequency)
    stiffer, _ = damped_sine(*beam.ring_down(1.0, "soft_modulus", scale=1.44), 1.2 * beam.frequency)
    assert stiffer / plain == pytest.approx(1.2, rel=2e-3)
