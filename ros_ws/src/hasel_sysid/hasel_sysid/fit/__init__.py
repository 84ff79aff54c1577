"""Identification of a model's free parameters from recordings."""

from hasel_sysid.fit.adam import fit_adam
from hasel_sysid.fit.from_afar import fit_from_afar
from hasel_sysid.fit.identify import METHODS, identify
from hasel_sysid.fit.least_squares import fit_least_squares
from hasel_sysid.fit.opening import in_step
from hasel_sysid.fit.result import FitResult

__all__ = ["METHODS", "FitResult", "fit_adam", "fit_from_afar", "fit_least_squares", "identify", "in_step"]
