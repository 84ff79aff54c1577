"""Runs of the simulator, for tests, as if a model's angle had been measured without noise."""

from collections.abc import Iterable

import numpy as np
from hasel_recording import Recording
from hasel_sim.model import Model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Problem
from hasel_sysid.testing.made_up_world import box_drive


def simulated_runs(truth: Model, drives: Iterable[tuple[float, float]], time: np.ndarray) -> Problem:
    """One run per voltage [V] and frequency [Hz] of a box drive, at these times [s] [n]."""
    experiments = []
    for voltage, frequency in drives:
        schedule = box_drive(voltage, frequency)
        run = Run(f"{voltage:.0f} V, {frequency} Hz", time, schedule)
        angle = simulate(truth, run).sin_theta
        experiments.append(Experiment(Recording(run.name, time, angle, drive_signal=schedule.at(time)), run))
    return Problem(experiments, SerialExecutor())
