"""A model: body, material, numerics, effects and parameter values; read from and written to one YAML file."""

from hasel_sim.model.model import Model
from hasel_sim.model.parameter import Parameter
from hasel_sim.model.read import load_model, model_names, save_model

__all__ = ["Model", "Parameter", "load_model", "model_names", "save_model"]
