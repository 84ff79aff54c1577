# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A model: body, material, numerics, effects and parameter values; read from and written to one YAML file."""

from hasel_sim.model.model import Model
from hasel_sim.model.model_file import load_model, model_names, save_model
from hasel_sim.parameter import Parameter

__all__ = ["Model", "Parameter", "load_model", "model_names", "save_model"]
