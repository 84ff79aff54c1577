"""A diagnosis of made-up residuals: what each effect would change is known exactly."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sysid.diagnosis.context import Context, expected_squares
from hasel_sysid.diagnosis.signature import Signature
from hasel_sysid.noise import NoiseModel
from hasel_sysid.projection import orthonormal

FRAMES = 1200
TIME = np.arange(FRAMES) / 120.0
RUNS = np.repeat(np.arange(4), FRAMES // 4)
NOISE = NoiseModel(white=1e-5, coloured=0.0, correlation=0.5)
FITTED = np.cos(2 * np.pi * TIME)[:, None]
SHAPES = {
    "sine": np.sin(2 * np.pi * TIME),
    "much_alike": np.sin(2 * np.pi * TIME) + 0.05 * np.sin(14 * np.pi * TIME),
    "other": np.sin(10 * np.pi * TIME),
    "swallowed": np.cos(2 * np.pi * TIME),
}


@pytest.fixture
def context():
    """Make the context in which `hidden` of the effect "sine" is there, and named, and all are fitted exactly."""

    def make(hidden: float, chance: float = 0.002) -> Context:
        residual = hidden * SHAPES["sine"] + NOISE.sample(RUNS, 1, np.random.default_rng(0))[:, 0]
        basis = orthonormal(FITTED)
        residual = residual - basis @ (basis.T @ residual)
        signatures, finals, squares = {}, {}, {}
        for name, shape in SHAPES.items():
            left = shape - basis @ (basis.T @ shape)
            columns = np.column_stack([shape, shape])
            signatures[name] = Signature(name, shape, left, columns, 0.0, 1.0)
            rest = residual - np.column_stack([FITTED, shape]) @ _solve(shape, residual)
            finals[name] = _fit(name, rest, np.column_stack([FITTED, shape]))
            squares[name] = float(rest @ rest)
        floor = expected_squares(FITTED, NOISE, RUNS)
        effects = [_effect(name) for name in SHAPES]
        base = _fit("", residual, FITTED)
        return Context(effects, base, finals, signatures, squares, NOISE, floor, chance, {}, winner="sine")

    return make


def _effect(name: str) -> SimpleNamespace:
    size = SimpleNamespace(name="size", unit="1", null=0.0, lower=0.0, upper=10.0, typical=1.0, scan=())
    return SimpleNamespace(id=name, parameters=[size], source=None)


def _solve(shape: np.ndarray, residual: np.ndarray) -> np.ndarray:
    return np.linalg.lstsq(np.column_stack([FITTED, shape]), residual, rcond=None)[0]


def _fit(name: str, residual: np.ndarray, jacobian: np.ndarray) -> SimpleNamespace:
    passive = SimpleNamespace(run=SimpleNamespace(name="swing", schedule=None, time=TIME[RUNS == 0]))
    evaluation = SimpleNamespace(
        residual=residual,
        jacobian=jacobian,
        runs=RUNS,
        sum_of_squares=float(residual @ residual),
        mean_absolute_error=float(np.abs(residual).mean()),
        simulations=[passive] * 4,
    )
    effects = [SimpleNamespace(id=name, parameters=[SimpleNamespace(name="size", null=0.0)])]
    model = SimpleNamespace(effects=effects, values={f"{name}.size": 0.5})
    return SimpleNamespace(evaluation=evaluation, model=model, at_bound=(), undetermined=())
