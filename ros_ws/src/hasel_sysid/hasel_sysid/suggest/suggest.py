"""Which experiment would make the remaining explanations differ most, in units of the noise."""

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from hasel_recording import HASEL_PAIR
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.simulate import simulate

from hasel_sysid.draft import draft
from hasel_sysid.drive_match import drive_unit, model_channels
from hasel_sysid.errors import SysidError
from hasel_sysid.noise import NoiseModel
from hasel_sysid.suggest.manoeuvre import Manoeuvre, manoeuvres

Progress = Callable[[str, float], None]


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
    progress: Progress | None = None,
    brief: bool = False,
) -> list[Suggestion]:
    """Rank all safe experiments, best first.

    candidates: fitted models by the effect that each adds; highest: largest level allowed, in the unit of the drive;
    brief: only a few experiments, at the highest level. An experiment is as good as it is for the pair of explanations
    that it separates least. Raises SysidError where none is possible.
    """
    model = next(iter(candidates.values()))
    levels, channels, unit = model.levels, model_channels(model) or HASEL_PAIR, drive_unit(model)
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
    futures = [
        {name: pool.submit(simulate, draft(model), manoeuvre.run()) for name, model in candidates.items()}
        for manoeuvre in library
    ]
    found = []
    for number, (manoeuvre, pending) in enumerate(zip(library, futures, strict=True)):
        try:
            series = {name: future.result().sin_theta for name, future in pending.items()}
        except SimulationError:
            continue
        found.append(_suggestion(manoeuvre, series, noise))
        if progress:
            progress(str(manoeuvre), (number + 1) / len(library))
    return sorted(found, key=lambda suggestion: -suggestion.difference)


def _suggestion(manoeuvre: Manoeuvre, series: dict[str, np.ndarray], noise: NoiseModel) -> Suggestion:
    pairs = {}
    for one, other in combinations(sorted(series), 2):
        difference = series[one] - series[other]
        pairs[(one, other)] = float(np.std(difference) / noise.standard_deviation)
    return Suggestion(manoeuvre, min(pairs.values()), pairs)
