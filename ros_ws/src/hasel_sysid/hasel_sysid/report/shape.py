"""The body's shape over one swing, as it is simulated."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.build import model_mesh
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import HaselSimError
from hasel_sim.mechanics.simd import LANES
from hasel_sim.model import Model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate_many

from hasel_sysid.compare.run_comparison import RunComparison

_LONGEST_S, _SHAPES = 1.5, 7


@dataclass(frozen=True)
class Shapes:
    """run: its name; time [s] [k]; skin: pieces of the outline [m] [k, pieces, 3, 2]; markers [m] [k, markers, 2]."""

    run: str
    time: np.ndarray
    skin: np.ndarray
    markers: np.ndarray


def simulated_shapes(model: Model, runs: Sequence[RunComparison]) -> Shapes | None:
    """Shapes over half a cycle, early in the most strongly driven run that repeats; None where there is none."""
    driven = [run.series for run in runs if run.series.cycle is not None and run.series.level > 0]
    if not driven:
        return None
    series = max(driven, key=lambda each: each.level)
    half = 0.5 * series.cycle.period
    begin = min(half, _LONGEST_S - min(half, _LONGEST_S)) + series.drive_time[0]
    wanted = begin + np.linspace(0.0, min(half, _LONGEST_S), _SHAPES)
    schedule = DriveSchedule(
        series.drive_time, series.drive_values, tuple(channel.name for channel in series.channels)
    )
    # as many beside each other as there are runs: for them the loops are loaded already, for one alone not
    cases = [(model, Run(series.name, wanted, schedule))] * min(len(runs), LANES[-1])
    found = simulate_many(cases, keep_shapes=True)[0]
    if isinstance(found, HaselSimError):
        return None
    return Shapes(series.name, wanted, found.shapes[:, model_mesh(model).skin], found.markers)
