# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Effects that are hidden in the truth and stand in no catalogue, as a user would write them."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter, ForceEffect, SiteState
from hasel_sim.effects.first_order_lag import first_order_lag

_START, _LENGTH = 0.1, 0.09
"""Where the stream of a stirred bath begins to act, from the nose, and how long its reach is [m]."""


class CubicDrag(ForceEffect):
    """Drag that grows with the third power of the normal velocity."""

    id = "cubic_drag"
    physics = "Waves carry energy away from the moving surface, the more the faster it moves."
    equation = "f = -c abs(v.n)^2 (v.n) n per skin length"
    parameters = (EffectParameter("coefficient", "c", "N s^3/m^5", 0.0, 0.0, 1e5, 500.0),)
    sites = "skin"
    depends_on = ("velocity", "tangent")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per skin length [N/m^2], [n, 2]."""
        speed = np.sum(at.velocity * at.normal, axis=1)
        return (-p.coefficient * speed**3)[:, None] * at.normal


class ElectrodeLeakage(DriveEffect):
    """Cross-talk: the other muscle's voltage arrives late and weakened."""

    id = "electrode_leakage"
    physics = "Charge leaks from one muscle's electrodes to the other's through the layer between them."
    equation = "V_i <- V_i + kappa q_j, dq_j/dt = (V_j - q_j) / tau"
    parameters = (
        EffectParameter("coupling", "kappa", "1", 0.0, 0.0, 1.0, 0.4),
        EffectParameter("time", "tau", "s", 0.3, 0.01, 10.0, 0.3),
    )
    stage = DriveStage.ELECTRODE

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Voltage on the electrodes [V] with what has leaked over."""
        return signal + p.coupling * first_order_lag(time, signal, p.time, p.time)[:, ::-1]


class HeavierBody(ForceEffect):
    """Additional inertia in proportion to the body's own."""

    id = "heavier_body"
    physics = "Liquid soaked up by the body moves with it."
    equation = "f = -r m a"
    parameters = (EffectParameter("ratio", "r", "1", 0.0, -0.5, 1.0, 0.25),)
    depends_on = ("acceleration",)

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per mass [N/kg], [n, 2]."""
        return -p.ratio * at.acceleration


class OneSidedDeadZone(DriveEffect):
    """A threshold in voltage of one muscle only."""

    id = "one_sided_dead_zone"
    physics = "The lower pouch's film sticks and zips only once the field has pulled it loose."
    equation = "V_lower <- sign(V_lower) max(0, abs(V_lower) - V_0)"
    parameters = (EffectParameter("threshold", "V_0", "V", 0.0, 0.0, 3000.0, 500.0),)
    stage = DriveStage.ZIPPING

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Voltage [V] that the zipped state corresponds to."""
        lower = np.sign(signal[:, 1]) * np.maximum(np.abs(signal[:, 1]) - p.threshold, 0.0)
        return np.stack([signal[:, 0], lower], axis=1)


class StirredBath(ForceEffect):
    """A periodic force that has nothing to do with the drive."""

    id = "stirred_bath"
    physics = "A pump's pulsating stream pushes the rear of the body sideways."
    equation = "f = m g_s ((x - 0.1 m) / 0.09 m)_+ sin(2 pi f_s t)"
    parameters = (
        EffectParameter("acceleration", "g_s", "m/s^2", 0.0, 0.0, 5.0, 0.4),
        EffectParameter("frequency", "f_s", "1/s", 1.3, 0.1, 10.0, 1.3),
    )
    depends_on = ()

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per mass [N/kg], [n, 2]."""
        reach = np.clip((at.reference[:, 0] - _START) / _LENGTH, 0.0, 1.0)
        push = p.acceleration * np.sin(2 * np.pi * p.frequency * at.time) * reach
        return np.stack([np.zeros_like(push), push], axis=1)


class TiredByStrokes(DriveEffect):
    """Contraction depends on the number of strokes so far, not on time."""

    id = "tired_by_strokes"
    physics = "Each stroke drains the supply's reservoir a little, so every stroke is weaker than the last."
    equation = "a <- a (1 - d)^(strokes of either muscle before)"
    parameters = (EffectParameter("loss", "d", "1", 0.0, 0.0, 0.3, 0.07),)
    stage = DriveStage.TARGET

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction aimed at [1], smaller by a step at each switching on."""
        on = signal > 0
        strokes = np.sum(on & ~np.vstack([[False, False], on[:-1]]), axis=1)
        before = np.maximum(np.cumsum(strokes) - 1, 0)
        return signal * (1 - p.loss) ** before[:, None]


UNLISTED = {
    kind.id: f"{Path(__file__)}:{kind.__name__}"
    for kind in (CubicDrag, ElectrodeLeakage, HeavierBody, OneSidedDeadZone, StirredBath, TiredByStrokes)
}
"""Name -> what a model file would call it."""
