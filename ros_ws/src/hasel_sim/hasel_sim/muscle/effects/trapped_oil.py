# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Trapped oil: a thin layer of liquid stays between the zipped films."""

from dataclasses import replace
from types import SimpleNamespace

from hasel_sim.effects.base import EffectParameter
from hasel_sim.muscle.effect import MuscleEffect
from hasel_sim.muscle.pouch import Pouch

_OIL = 3.0
"""Relative permittivity of the ester oils in use, 2.2 to 3.2 [1]."""


class TrappedOil(MuscleEffect):
    """Liquid and rough electrodes keep the films a little apart, a capacitor in series with theirs."""

    id = "trapped_oil"
    physics = "Liquid that does not get out from between the films, and rough electrodes, thicken the zipped capacitor."
    equation = "2 t / eps_r -> 2 t / eps_r + g / 3"
    parameters = (
        EffectParameter("gap", "g", "m", 0.0, 0.0, 40e-6, 5e-6, "roughness and residual liquid (estimate)"),
    )
    signature = "Less force by one factor at all voltages and strains, whatever the width."
    citation = "series capacitors; Kellaris et al., Science Robotics 3 (2018) eaar3276 (films and liquid)"

    def pouches(self, pouch: Pouch, p: SimpleNamespace) -> list[tuple[float, Pouch]]:
        """The pouch with films as thick as they seem."""
        thickness = pouch.film_thickness + 0.5 * p.gap * pouch.relative_permittivity / _OIL
        return [(1.0, replace(pouch, film_thickness=thickness))]
