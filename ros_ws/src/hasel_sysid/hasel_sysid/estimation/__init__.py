"""Identification of a model's free parameters from recordings."""

from hasel_sysid.estimation.adam import fit_adam
from hasel_sysid.estimation.from_afar import fit_from_afar
from hasel_sysid.estimation.identify import METHODS, identify
from hasel_sysid.estimation.least_squares import fit_least_squares
from hasel_sysid.estimation.opening import in_step, is_close
from hasel_sysid.estimation.result import FitResult

__all__ = [
    "METHODS",
    "FitResult",
    "fit_adam",
    "fit_from_afar",
    "fit_least_squares",
    "identify",
    "in_step",
    "is_close",
]
