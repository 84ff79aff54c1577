"""Which experiment would make the remaining explanations differ most, in units of the noise."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from hasel_common.progress import Workload
from hasel_recording import HASEL_PAIR
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.simd import LANES
from hasel_sim.simulate import simulate_many

from hasel_sysid.drive_match import model_channels
from hasel_sysid.errors import SysidError
from hasel_sysid.expected_work import NEXT_RUNS, work_of
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.problem import low_fidelity
from hasel_sysid.suggest.manoeuvre import Manoeuvre, manoeuvres


@dataclass(frozen=True)
class Suggestion:
    """difference: rms difference between the two most similar of the remaining explanations, in units of the noise;
    pairs: the same for every pair of them.
    """

    manoeuvre: Manoeuvre
    difference: float
    pairs: dict[tuple[str, str], float]

    def to_json(self) -> dict:
        """For machines: the run as a RunExperiment goal, and the differences in units of the noise."""
        pairs = [{"effects": list(pair), "difference": size} for pair, size in self.pairs.items()]
        return {"run": self.manoeuvre.goal(), "difference": self.difference, "pairs": pairs}

    def __str__(self) -> str:
        names = sorted({name for pair in self.pairs for name in pair})
        return f"{self.manoeuvre}: {', '.join(names)} would differ by {self.difference:.1f} times the noise."


def suggest(
    pool: Executor,
    candidates: dict[str, Model],
    noise: NoiseModel,
    highest: float,
    workload: Workload | None = None,
    brief: bool = False,
) -> list[Suggestion]:
    """Rank all safe experiments, best first.

    candidates: fitted models by the effect that each adds; highest: largest level allowed, in the unit of the drive;
    brief: only a few experiments, at the highest level; workload: counts simulations. An experiment is as good as it is
    for the pair of explanations that it separates least. Raises SysidError where none is possible.
    """
    model = next(iter(candidates.values()))
    levels, channels, unit = model.levels, model_channels(model) or HASEL_PAIR, model.drive_unit
    if len(levels) and not unit:
        raise SysidError(
            f"model '{model.name}' is driven by {', '.join(map(str, channels))}, and experiments are only proposed for "
            "channels of one unit: plan the next run by hand"
        )
    library = manoeuvres(levels, highest, brief, channels)
    if not library:
        raise SysidError(
            f"no experiment is possible: the highest level allowed is {highest:g} {unit} and the lowest known one "
            f"{levels[0]:g} {unit}; raise --max-voltage"
        )
    coarse = {name: low_fidelity(model) for name, model in candidates.items()}
    workload = workload or Workload()
    runs = [manoeuvre.run() for manoeuvre in library]
    work = sum(work_of(each, runs) for each in coarse.values())
    futures = [
        {name: pool.submit(_simulated, each, group) for name, each in coarse.items()}
        for group in _alike(library)
    ]
    found = []
    with workload.stage(replace(NEXT_RUNS, work=work, known=True)):
        for group, pending in zip(_alike(library), futures, strict=True):
            simulated = {name: future.result() for name, future in pending.items()}
            for index, manoeuvre in enumerate(group):
                series = {name: each[index] for name, each in simulated.items() if each[index] is not None}
                if len(series) == len(coarse):
                    found.append(_suggestion(manoeuvre, series, noise))
                for model in coarse.values():
                    workload.did(work_of(model, [manoeuvre.run()]))
            workload.check()
    return sorted(found, key=lambda suggestion: -suggestion.difference)


def _alike(library: Sequence[Manoeuvre]) -> list[list[Manoeuvre]]:
    """In groups of about the same duration, each as large as runs are simulated side by side."""
    by_duration = sorted(library, key=lambda manoeuvre: len(manoeuvre.run().time))
    return [by_duration[first : first + LANES[-1]] for first in range(0, len(by_duration), LANES[-1])]


def _simulated(model: Model, group: Sequence[Manoeuvre]) -> list[np.ndarray | None]:
    """The angle in every manoeuvre; None where the motion could not be followed."""
    series: list[np.ndarray | None] = []
    for result in simulate_many([(model, manoeuvre.run()) for manoeuvre in group]):
        if isinstance(result, Exception) and not isinstance(result, SimulationError):
            raise result
        series.append(None if isinstance(result, Exception) else result.sin_theta)
    return series


def _suggestion(manoeuvre: Manoeuvre, series: dict[str, np.ndarray], noise: NoiseModel) -> Suggestion:
    pairs = {}
    for one, other in combinations(sorted(series), 2):
        difference = series[one] - series[other]
        pairs[(one, other)] = float(np.std(difference) / noise.standard_deviation)
    return Suggestion(manoeuvre, min(pairs.values()), pairs)
