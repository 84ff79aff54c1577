# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The body's extreme shapes, as it is simulated, and where the measured angle puts its tail."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model
from hasel_sim.model_mesh import model_mesh
from hasel_sim.run import Run
from hasel_sim.simd import LANES
from hasel_sim.simulate import simulate_many

from hasel_sysid.comparison import RunComparison

_LONGEST_S = 1.5


def measured_tail(markers: np.ndarray, sin_theta: np.ndarray) -> np.ndarray:
    """The tail [m] [n, 2] at its simulated distance from the middle marker, in the measured direction.

    markers [m] [n, 3, 2]: simulated head, middle, tail; sin_theta [n]: measured, the run's offset taken out.
    """
    body, fin = markers[:, 1] - markers[:, 0], markers[:, 2] - markers[:, 1]
    sine = np.clip(sin_theta, -1.0, 1.0)
    cosine = np.sqrt(1.0 - sine**2)
    turned = np.stack(
        [body[:, 0] * cosine - body[:, 1] * sine, body[:, 0] * sine + body[:, 1] * cosine], axis=-1
    )
    ratio = np.linalg.norm(fin, axis=-1) / np.linalg.norm(body, axis=-1)
    return markers[:, 1] + turned * ratio[:, None]


@dataclass(frozen=True)
class Shapes:
    """run: its name; time [s] [k]; skin: pieces of the outline [m] [k, pieces, 3, 2]; markers [m] [k, 3, 2] as
    simulated; measured [m] [k, 3, 2]: the same with the tail in the measured direction. The first instant is the start.
    """

    run: str
    time: np.ndarray
    skin: np.ndarray
    markers: np.ndarray
    measured: np.ndarray


def simulated_shapes(model: Model, runs: Sequence[RunComparison]) -> Shapes | None:
    """Of the most strongly driven run that repeats, in its first cycle; None where there is none."""
    driven = [
        (run.series, run.series.cycle, run.series.drive)
        for run in runs
        if run.series.cycle is not None and run.series.drive is not None and run.series.level > 0
    ]
    if not driven:
        return None
    series, cycle, drive = max(driven, key=lambda each: each[0].level)
    early = series.time <= series.time[0] + min(cycle.period, _LONGEST_S)
    ends = {0, int(np.argmax(series.simulated[early])), int(np.argmin(series.simulated[early]))}
    chosen = sorted(ends)
    wanted = series.time[chosen]
    schedule = DriveSchedule(*drive, tuple(channel.name for channel in series.channels))
    # as many beside each other as there are runs: for them the loops are loaded already, for one alone not
    cases = [(model, Run(series.name, wanted, schedule))] * min(len(runs), LANES[-1])
    found = simulate_many(cases, keep_shapes=True)[0]
    if isinstance(found, HaselSimError) or found.shapes is None:
        return None
    markers = found.markers[:, :3]
    measured = markers.copy()
    measured[:, 2] = measured_tail(markers, (series.measured - series.offset)[chosen])
    return Shapes(series.name, wanted, found.shapes[:, model_mesh(model).skin], markers, measured)
