"""Whether a model describes its runs to the noise, in every regime of them, and where it does not."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaincc

from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Evaluation
from hasel_sysid.projection import orthonormal
from hasel_sysid.where_it_fails.drive_cycle import drive_cycle, driven_side

_DRAWS = 400
_FEWEST_FRAMES = 8
_QUARTERS = 4


@dataclass(frozen=True)
class LackOfFit:
    """A regime in which a model does not describe its runs; times: its rms error over the allowed one."""

    regime: str
    times: float

    def __str__(self) -> str:
        return f"{self.regime} ({self.times:.1f} times)"


@dataclass(frozen=True)
class GoodnessOfFit:
    """times: mean error of all frames over the allowed one; lacking: regimes in which it fails, worst first.

    allowed: mean |Δ sin θ| that a right model may leave.
    """

    times: float
    allowed: float
    lacking: tuple[LackOfFit, ...] = ()

    @property
    def overall(self) -> bool:
        """Whether all frames together are near what is allowed."""
        return self.times <= POLICY.near_noise

    @property
    def adequate(self) -> bool:
        """Whether the model describes these runs, everywhere."""
        return self.overall and not self.lacking

    def __str__(self) -> str:
        if self.adequate:
            return f"The model describes these runs: its error is {self.times:.2f} times what is allowed for."
        where = ", ".join(map(str, self.lacking[:3]))
        where = f", most in {where}" if where else ""
        return (
            f"The model does not describe these runs yet: its error is {self.times:.3g} times the {self.allowed:.2g} "
            f"that is allowed for{where}."
        )


def goodness_of_fit(evaluation: Evaluation, allowed: NoiseModel) -> GoodnessOfFit:
    """Lack of fit against what a right model may leave, overall and per regime (Benjamini and Hochberg 1995).

    allowed: noise and discrepancy. Regimes: run, output, largest drive, frequency, side, quarter of the cycle.
    """
    basis = orthonormal(evaluation.jacobian)
    draws = allowed.sample(evaluation.series, _DRAWS, np.random.default_rng(2), evaluation.free_offset)
    draws -= basis @ (basis.T @ draws)
    squares, by_noise = evaluation.residual**2, draws**2
    found, chances = [], []
    for name, frames in regimes(evaluation):
        if frames.sum() < _FEWEST_FRAMES:
            continue
        own, expected = squares[frames].mean(), by_noise[frames].mean(axis=0)
        found.append(LackOfFit(name, float(np.sqrt(own / expected.mean()))))
        chances.append(_chance(own, expected))
    rejected = _beyond_chance(np.array(chances))
    lacking = [
        m for m, beyond in zip(found, rejected, strict=True) if beyond and m.times > POLICY.lack_of_fit
    ]
    times = evaluation.mean_absolute_error / allowed.mean_absolute
    lacking.sort(key=lambda one: -one.times)
    return GoodnessOfFit(float(times), allowed.mean_absolute, tuple(lacking))


def regimes(evaluation: Evaluation) -> Iterator[tuple[str, np.ndarray]]:
    """Name and frames of every regime; those that all frames share are left out."""
    labels = _labels(evaluation)
    for kind, values in labels.items():
        every = [v for v in dict.fromkeys(values) if v]
        if len(every) > 1:
            for value in every:
                yield f"{kind} {value}".strip(), np.array([v == value for v in values])


def _labels(evaluation: Evaluation) -> dict[str, list[str]]:
    labels: dict[str, list[str]] = {
        "run": [],
        "output": [],
        "": [],
        "frequency": [],
        "side": [],
        "part of the cycle": [],
    }
    for simulation, output, used, _ in evaluation.each_series():
        run = simulation.run
        count, time = int(used.sum()), run.time[used]
        voltage = None if run.schedule is None else run.schedule.at(time)
        cycle = None if voltage is None or count < 2 else drive_cycle(time, voltage)
        level = ""
        if run.schedule is not None:
            unit = evaluation.model.drive_unit
            level = f"{np.abs(run.schedule.signal).max(initial=0.0):.5g} {unit}"
        side = [""] * count
        if voltage is not None:
            first, *others = run.schedule.channels
            names = {1: first, -1: " or ".join(others), 0: ""}
            side = [names[s] for s in driven_side(voltage)]
        part = [""] * count
        if cycle is not None:
            part = [f"{int(_QUARTERS * p) + 1} of {_QUARTERS}" for p in cycle.phase(time)]
        labels["run"] += [run.name] * count
        labels["output"] += [str(output + 1)] * count
        labels[""] += [level] * count
        labels["frequency"] += [f"{1 / cycle.period:.3g} Hz" if cycle else ""] * count
        labels["side"] += side
        labels["part of the cycle"] += part
    return labels


def _chance(own: float, drawn: np.ndarray) -> float:
    """Chance of a mean square of at least this size, from draws of it by noise alone.

    A scaled chi-square with the draws' mean and variance (Satterthwaite, Biometrics 2 (1946) 110): of noise that
    neighbouring frames share few are independent, and a normal tail would be too thin.
    """
    variance = float(drawn.var())
    if not variance > 0:
        return 1.0
    half_freedom = drawn.mean() ** 2 / variance
    return float(gammaincc(half_freedom, half_freedom * own / drawn.mean()))


def _beyond_chance(chance: np.ndarray) -> np.ndarray:
    """Which of many chances are too small, with few false ones among them."""
    if len(chance) == 0:
        return np.zeros(0, dtype=bool)
    order = np.argsort(chance)
    line = POLICY.level * np.arange(1, len(chance) + 1) / len(chance)
    below = np.flatnonzero(chance[order] <= line)
    rejected = np.zeros(len(chance), dtype=bool)
    if len(below):
        rejected[order[: below[-1] + 1]] = True
    return rejected
