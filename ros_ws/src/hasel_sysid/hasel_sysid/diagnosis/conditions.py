"""Level of the drive and frequency of every run, by which laws are judged and runs left out."""

from collections.abc import Sequence

import numpy as np
from hasel_sim.run import Simulation

from hasel_sysid.where_it_fails.drive_cycle import drive_cycle


def conditions(simulations: Sequence[Simulation]) -> dict[str, np.ndarray]:
    """Largest level and frequency of the drive [Hz] of every run, [runs]; NaN where there is none."""
    return {
        "level": np.array([_peak(s) for s in simulations]),
        "frequency": np.array([_frequency(s) for s in simulations]),
    }


def _peak(simulation: Simulation) -> float:
    schedule = simulation.run.schedule
    peak = 0.0 if schedule is None else float(np.abs(schedule.signal).max(initial=0.0))
    return peak if peak > 0 else np.nan


def _frequency(simulation: Simulation) -> float:
    run = simulation.run
    if run.schedule is None or len(run.time) < 2:
        return np.nan
    cycle = drive_cycle(run.time, run.schedule.at(run.time))
    return np.nan if cycle is None else 1.0 / cycle.period
