"""What an effect looks like in the residual, once the fitted parameters have imitated what they can."""

from dataclasses import dataclass

import numpy as np

from hasel_sysid.diagnosis.trial import Trial
from hasel_sysid.noise import NoiseModel
from hasel_sysid.projection import orthonormal


@dataclass(frozen=True)
class Signature:
    """change [frames]: of the simulated series by the effect at its typical size; left [frames]: what the fitted
    parameters cannot imitate; null, typical: value of the effect's first parameter without it and there.
    """

    effect: str
    change: np.ndarray
    left: np.ndarray
    columns: np.ndarray
    null: float
    typical: float

    @property
    def size(self) -> float:
        """How far the typical value is from the null."""
        return self.typical - self.null

    @property
    def swallowed(self) -> float:
        """Share of the signature that the fitted parameters imitate, 0 to 1."""
        size = np.linalg.norm(self.change)
        return 1.0 if size == 0 else float(1 - np.linalg.norm(self.left) / size)

    def score(self, residual: np.ndarray, noise: NoiseModel, runs: np.ndarray) -> tuple[float, float]:
        """Expected size, as a multiple of the typical one, and its standard error (infinite when it is invisible)."""
        power = float(self.left @ self.left)
        if power <= 1e-30:
            return 0.0, float("inf")
        spread = float(self.left @ noise.covariance_product(self.left[:, None], runs)[:, 0])
        return float(self.left @ residual) / power, float(np.sqrt(spread)) / power


def signature(
    trial: Trial, base_residual: np.ndarray, fitted: np.ndarray, typical: dict[str, float]
) -> Signature:
    """The signature of a first trial.

    base_residual: of the model without the effect; fitted [frames, n]: derivatives by its parameters. Where the trial
    starts at the null, the derivative there times the typical size stands for the change.
    """
    effect = trial.start.effect
    own = [index for index, name in enumerate(trial.names) if name in trial.start.values]
    change = base_residual - trial.residual
    first = next((p for p in effect.parameters if not p.scan), effect.parameters[0])
    at_null = [i for i in own if trial.start.values[trial.names[i]] == _null(effect, trial.names[i])]
    for index in at_null:
        name = trial.names[index]
        change = change + trial.jacobian[:, index] * (typical[name] - trial.start.values[name])
    basis = orthonormal(fitted)
    columns = np.column_stack([change, trial.jacobian[:, own]])
    return Signature(
        effect.id,
        change,
        change - basis @ (basis.T @ change),
        columns,
        first.null,
        typical[f"{effect.id}.{first.name}"],
    )


def _null(effect, name: str) -> float:
    return next(p.null for p in effect.parameters if f"{effect.id}.{p.name}" == name)
