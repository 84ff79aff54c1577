# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Part of the drive arrives slowly, as the wall of an inflated chamber goes on giving way."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter
from hasel_sim.effects.first_order_lag import first_order_lag


class DriveCreep(DriveEffect):
    """Creep between what is commanded and what bends the body: of a chamber's wall, a bladder or a tendon."""

    id = "drive_creep"
    physics = "The wall of an inflated chamber goes on stretching under constant pressure, so the drive still grows."
    equation = "dq/dt = (p - q) / tau, p_eff = (1 - beta) p + beta q"
    parameters = (
        EffectParameter(
            "fraction",
            "beta",
            "1",
            0.0,
            0.0,
            0.5,
            0.1,
            "5-25 % between 1 s and minutes in platinum-cured silicones (estimate)",
            usual=(0.05, 0.25),
        ),
        EffectParameter(
            "time", "tau", "s", 1.0, 0.05, 60.0, 1.0, "0.1-30 s (estimate)", scan=(0.2, 1.0, 5.0, 20.0)
        ),
    )
    signature = (
        "Bending goes on growing while the drive is held, most where a little more drive bends a lot more; what is "
        "left after switching off fades with the same time."
    )
    confused_with = ("viscoelastic_creep", "slow_creep", "charging_lag")
    separated_by = (
        "Ring-downs: creep of the body changes their decay and frequency, creep of the drive does not; steps to "
        "several levels: this one grows with the slope of bending over drive."
    )
    citation = "Marechal, Balland, Lindenroth, Petrou, Kontovounisios, Bello, Soft Robotics 8 (2021) 284"
    stage = DriveStage.ZIPPING

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Effective drive from the one at the body's inlet, both signed."""
        return (1.0 - p.fraction) * signal + p.fraction * first_order_lag(time, signal, p.time, p.time)
