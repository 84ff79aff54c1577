# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Marker offset: the middle marker sits beside the centre line."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ObservationEffect


class MarkerOffset(ObservationEffect):
    """Middle marker fixed to the body at a distance from its centre line."""

    id = "marker_offset"
    physics = "The middle marker was glued beside the centre line and turns and strains with the body there."
    equation = "x_middle <- x_middle + d N, N the material line through it that was upright at rest"
    parameters = (
        EffectParameter(
            "offset", "d", "m", 0.0, -0.005, 0.005, 0.001, "gluing by hand: up to some millimetres"
        ),
    )
    signature = "A constant angle, the same at every voltage and frequency, with a slight change of gain."
    confused_with = ("pre_bend", "muscle_asymmetry", "gravity_tilt")
    separated_by = "A photograph at rest; turn the body over: a bend of the body changes sign with it."
    citation = "Chiari et al., Gait and Posture 21 (2005) 197 (marker placement errors)"

    def markers(self, positions: np.ndarray, across: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Where the camera sees the markers [m] [n, 3, 2]."""
        return positions + p.offset * across * np.array([0.0, 1.0, 0.0])[:, None]
