"""A diagnosis of made-up residuals: what each effect would change is known exactly."""

import numpy as np
import pytest
from hasel_sim.effects.base import Effect
from hasel_sim.model import load_model
from hasel_sim.run import Run
from hasel_sysid.diagnosis.context import Context, expected_squares
from hasel_sysid.diagnosis.signature import Signature
from hasel_sysid.estimation import FittedModel
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.projection import orthonormal
from hasel_sysid.testing.made_up_effects import made_up_effect, with_made_up
from hasel_sysid.testing.made_up_runs import evaluation_of_runs

FRAMES = 1200
TIME = np.arange(FRAMES) / 120.0
RUNS = np.repeat(np.arange(4), FRAMES // 4)
SWINGS = [Run(f"swing {number}", time) for number, time in enumerate(np.split(TIME, 4))]
NOISE = NoiseModel(white=1e-5, coloured=0.0, correlation=0.5)
MODULUS = "material.soft.youngs_modulus_pa"
FITTED = np.cos(2 * np.pi * TIME)[:, None]
SHAPES = {
    "sine": np.sin(2 * np.pi * TIME),
    "much_alike": np.sin(2 * np.pi * TIME) + 0.05 * np.sin(14 * np.pi * TIME),
    "other": np.sin(10 * np.pi * TIME),
    "swallowed": np.cos(2 * np.pi * TIME),
}


@pytest.fixture
def context():
    """Make the context in which `hidden` of the effect "sine" is there, and named, and all are fitted exactly.

    Every fit is of a clamped beam that swings four times, with one size of 0.5 ± 0.1.
    """

    def make(hidden: float, chance: float = 0.002) -> Context:
        residual = hidden * SHAPES["sine"] + NOISE.sample(RUNS, 1, np.random.default_rng(0))[:, 0]
        basis = orthonormal(FITTED)
        residual = residual - basis @ (basis.T @ residual)
        effects = [made_up_effect(name) for name in SHAPES]
        signatures, finals, squares = {}, {}, {}
        for effect, (name, shape) in zip(effects, SHAPES.items(), strict=True):
            left = shape - basis @ (basis.T @ shape)
            columns = np.column_stack([shape, shape])
            signatures[name] = Signature(name, shape, left, columns, 0.0, 1.0)
            rest = residual - np.column_stack([FITTED, shape]) @ _solve(shape, residual)
            finals[name] = _fit(rest, np.column_stack([FITTED, shape]), effect)
            squares[name] = float(rest @ rest)
        floor = expected_squares(FITTED, NOISE, RUNS)
        base = _fit(residual, FITTED)
        return Context(effects, base, finals, signatures, squares, NOISE, floor, chance, {}, winner="sine")

    return make


def _solve(shape: np.ndarray, residual: np.ndarray) -> np.ndarray:
    return np.linalg.lstsq(np.column_stack([FITTED, shape]), residual, rcond=None)[0]


def _fit(residual: np.ndarray, jacobian: np.ndarray, *effects: Effect) -> FittedModel:
    sizes = tuple(f"{effect.id}.size" for effect in effects)
    model = with_made_up(load_model("beam").with_freed(MODULUS), *effects)
    model = model.with_values(dict.fromkeys(sizes, 0.5), dict.fromkeys(sizes, 0.1))
    evaluation = evaluation_of_runs(SWINGS, residual, jacobian=jacobian, names=(MODULUS, *sizes), model=model)
    return FittedModel(model, evaluation, (), (), 1, "made up")
