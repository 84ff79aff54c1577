# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Structural damping: loss per cycle that does not depend on frequency."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import Coefficients, EffectParameter, MaterialEffect

_SPACING = 3.2
_TIMES = 0.0025 * _SPACING ** np.arange(9)
"""Relaxation times [s] of the bank, 0.0025 to 27 s; the loss is constant from 0.2 to 20 Hz."""
_REFERENCE = 2 * np.pi * 2.0
"""Angular frequency [rad/s] at which the stiffness stays the model's."""


class StructuralDamping(MaterialEffect):
    """A bank of Maxwell branches that stands for a spring-pot (power-law relaxation)."""

    id = "structural_damping"
    physics = (
        "Internal sliding of filler, interfaces and glue loses the same share of energy per cycle at any "
        "frequency."
    )
    equation = (
        "S = C : E (1 + i eta) from 0.2 to 20 Hz (branches of g ~ tau^-p, tan(p pi/2) = eta); stiffness kept "
        "at 2 Hz"
    )
    parameters = (
        EffectParameter(
            "loss_factor",
            "eta",
            "1",
            0.0,
            0.0,
            0.5,
            0.1,
            "polypropylene 0.09 (PMC7407174), filled elastomers 0.05-0.3",
            usual=(0.05, 0.3),
        ),
    )
    signature = "Logarithmic decrement pi eta at every frequency; lag after switches that no single time constant fits."
    confused_with = ("material_damping", "linear_drag", "surface_friction", "quadratic_drag")
    separated_by = "Ring-down at two frequencies (another length or payload): the decrement stays."
    citation = "Bishop, Proc. IMechE 169 (1955) 35 (hysteretic damping); Bagley and Torvik, J. Rheology 27 (1983) 201"

    def modify(self, coefficients: Coefficients, p: SimpleNamespace) -> None:
        """Take from the lasting stiffness what the branches carry at the reference frequency."""
        lasting, _, viscous = _bank(p.loss_factor)
        coefficients.equilibrium *= lasting
        coefficients.retardation += viscous

    def branches(self, p: SimpleNamespace) -> list[tuple[float, float]]:
        """The bank."""
        return list(zip(_bank(p.loss_factor)[1], _TIMES, strict=True))


def _bank(loss_factor: float) -> tuple[float, np.ndarray, float]:
    """Lasting share of the modulus, the branches' ratios and a retardation time [s]; storage modulus 1 at 2 Hz.

    A spring-pot (i omega)^p has the spectrum sin(pi p) / pi tau^-p per unit of ln tau; the part slower than the bank
    acts as lasting stiffness, the part faster than it as viscosity.
    """
    power = 2 / np.pi * np.arctan(loss_factor)
    fastest, slowest = _TIMES[0] / np.sqrt(_SPACING), _TIMES[-1] * np.sqrt(_SPACING)
    density = power * np.sinc(power)
    lasting = np.sinc(power) * (_REFERENCE * slowest) ** -power
    ratios = density * np.log(_SPACING) * (_REFERENCE * _TIMES) ** -power
    viscous = density * fastest * (_REFERENCE * fastest) ** -power / (1 - power)
    turn = (_REFERENCE * _TIMES) ** 2
    storage = lasting + np.sum(ratios * turn / (1 + turn))
    return lasting / storage, ratios / storage, viscous / storage
