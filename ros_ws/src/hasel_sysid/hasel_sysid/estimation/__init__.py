# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Identification of a model's free parameters from recordings."""

from hasel_sysid.estimation.fit import FittedModel, fit_baseline
from hasel_sysid.estimation.identify import METHODS, identify

__all__ = ["METHODS", "FittedModel", "fit_baseline", "identify"]
