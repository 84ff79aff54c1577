# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Muscle asymmetry: the two muscles are not equally strong."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class MuscleAsymmetry(DriveEffect):
    """Hand-filled pouches give the lower muscle another gain than the upper one."""

    id = "muscle_asymmetry"
    physics = "Hand-made muscles differ in filling and electrode area, so one contracts more than the other."
    equation = "lower amplitude = (1 - delta) x upper amplitude"
    parameters = (
        EffectParameter(
            "gain_difference",
            "delta",
            "1",
            0.0,
            -0.5,
            0.5,
            0.1,
            "5-15 % between hand-filled pouches (estimate)",
        ),
    )
    signature = "A mean deflection proportional to the amplitude, growing with voltage; no even harmonics."
    confused_with = ("pre_bend", "marker_offset", "gravity_tilt")
    separated_by = (
        "Swap the leads of the two muscles: an asymmetry of the muscles stays, one of the drive moves."
    )
    citation = "Kellaris, Gopaluni Venkata, Rothemund, Keplinger, Extreme Mechanics Letters 29 (2019) 100449"
    needs_antagonists = True
    stage = DriveStage.TARGET

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction aimed at [1] with the lower muscle's own gain."""
        return signal * np.array([1.0, 1.0 - p.gain_difference])
