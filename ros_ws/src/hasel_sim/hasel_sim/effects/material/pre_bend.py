# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Pre-bend: the body is not straight at rest."""

from types import SimpleNamespace

from hasel_sim.effects.base import Coefficients, EffectParameter, MaterialEffect


class PreBend(MaterialEffect):
    """Uniform curvature of the stress-free shape."""

    id = "pre_bend"
    physics = "Printed, stored bent or glued under stress, the body is curved when nothing acts on it."
    equation = "stretch of the stress-free shape along the body = 1 - kappa_0 y"
    parameters = (
        EffectParameter(
            "curvature",
            "kappa_0",
            "1/m",
            0.0,
            -2.0,
            2.0,
            0.3,
            "0-1 1/m: up to 0.1 rad at the tail (estimate)",
        ),
    )
    signature = "A constant angle, the same at every voltage and frequency."
    confused_with = ("muscle_asymmetry", "marker_offset", "gravity_tilt")
    separated_by = "A photograph at rest before and after each run; turn the body over: the sign changes."
    citation = "Timoshenko and Gere, Theory of Elastic Stability, 2nd ed. (1961), section 1.12"

    def modify(self, coefficients: Coefficients, p: SimpleNamespace) -> None:
        """Shorten the upper side and lengthen the lower side."""
        coefficients.rest_stretch *= 1.0 - p.curvature * coefficients.height
