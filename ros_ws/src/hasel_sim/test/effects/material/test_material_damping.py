# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Material damping."""

import pytest


@pytest.mark.parametrize("height", [0.01, 0.02])
def test_the_damping_ratio_is_half_of_frequency_times_retardation(height, cantilever, damped_sine):
    """Kelvin-Voigt: zeta = omega tau / 2, within 3 %, so that a stiffer beam is damped more."""
    beam, retardation = cantilever(height=height), 0.005
    omega, zeta = damped_sine(
        *beam.ring_down(1.5, "material_damping", retardation_time=retardation), beam.frequency
    )
    assert zeta == pytest.approx(omega * retardation / 2, rel=0.03)
