"""Whether a muscle describes its runs to what frames and repeated lifts scatter by."""

from dataclasses import dataclass

import numpy as np
from hasel_sim.muscle.muscle import Muscle
from scipy.stats import f as fisher

from hasel_sysid.bench_muscle.problem import BenchProblem

_SURE = 0.99


@dataclass(frozen=True)
class Adequacy:
    """error and allowed: root mean square of the holds by the largest answer [1]; what the allowance is made of."""

    error: float
    allowed: float
    noise: float
    repeats: float | None

    @property
    def describes(self) -> bool:
        """Whether nothing is left but noise."""
        return self.error <= self.allowed

    def __str__(self) -> str:
        of = f"noise {100 * self.noise:.2g} %"
        of += "" if self.repeats is None else f", lifts repeat to {100 * self.repeats:.2g} %"
        said = "describes these lifts" if self.describes else "does not describe these lifts yet"
        return (
            f"The model {said}: it is off by {100 * self.error:.2g} % of the largest answer, "
            f"{100 * self.allowed:.2g} % are allowed for ({of})."
        )


def adequacy(problem: BenchProblem, muscle: Muscle) -> Adequacy:
    """How a muscle's error compares with noise and repeatability.

    A ratio of mean squares (Fisher): holds against the frames that tell the noise, each of which is few.
    """
    squares = problem.per_hold(problem.residual(muscle))
    noise = float(np.sqrt(np.average(problem.noise**2, weights=problem.weights)))
    repeats = repeatability(problem)
    zero = float(np.sqrt(np.average((problem.zeros**2).sum(axis=1), weights=problem.weights)))
    scatter = np.sqrt(noise**2 + zero**2 + (repeats or 0.0) ** 2)
    known = max(2, min(run.noise_frames for run in problem.runs) - 1)
    allowed = scatter * np.sqrt(fisher.ppf(_SURE, len(squares), known))
    return Adequacy(float(np.sqrt(np.mean(squares))), float(allowed), noise, repeats)


def repeatability(problem: BenchProblem) -> float | None:
    """Standard deviation of lifts alike, by the answer's scale; None where no lift was repeated."""
    groups: dict[tuple, list[float]] = {}
    for run in problem.runs:
        for number in np.unique(run.hold[run.used & (run.voltage != 0)]):
            frames = run.used & (run.hold == number)
            kept = run.load if run.held == "load" else run.contraction
            key = (run.held, float(run.level[frames][0]), float(f"{np.median(kept[frames]):.2g}"))
            answer = run.contraction if run.held == "load" else run.load
            groups.setdefault(key, []).append(float(np.median(answer[frames])) / problem.scales[run.unit])
    repeated = [np.asarray(values) for values in groups.values() if len(values) > 1]
    if not repeated:
        return None
    squares = sum(float(np.sum((values - values.mean()) ** 2)) for values in repeated)
    return float(np.sqrt(squares / sum(len(values) - 1 for values in repeated)))
