# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Runs of a swimmer-like oscillator with a known truth, made without the simulator."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest
from hasel_recording import Recording
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run
from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.residual_analysis.run_series import RunSeries
from scipy.signal import lsim

FRAME_RATE = 120.0
_FINE = 2400.0


def _box(time: np.ndarray, frequency: float, upper: float, lower: float) -> np.ndarray:
    """+upper in the first half of every period, -lower in the second, nothing before t = 0."""
    first_half = np.mod(time * frequency, 1.0) < 0.5
    return np.where(time < 0, 0.0, np.where(first_half, upper, -lower))


@lru_cache(maxsize=64)
def _oscillation(
    end: float,
    frequency: float,
    upper: float,
    lower: float,
    natural_hz: float,
    damping_ratio: float,
    slope: float,
) -> tuple[np.ndarray, np.ndarray]:
    fine = np.arange(-0.5, end, 1 / _FINE)
    target, pull = _box(fine, frequency, upper, lower), np.zeros(len(fine))
    for step in range(1, len(fine)):
        pull[step] = pull[step - 1] + np.clip(target[step] - pull[step - 1], -slope / _FINE, slope / _FINE)
    omega = 2 * np.pi * natural_hz
    _, angle, _ = lsim(([omega**2], [1, 2 * damping_ratio * omega, omega**2]), pull, fine - fine[0])
    return fine, angle


def oscillator_angle(
    time: np.ndarray,
    frequency: float = 2.0,
    upper: float = 0.2,
    lower: float = 0.2,
    natural_hz: float = 2.4,
    damping_ratio: float = 0.15,
    slope: float = 2.0,
) -> np.ndarray:
    """sin theta [n] at times [s] [n] of a damped oscillator pulled by a rate-limited box."""
    end = float(np.ceil(time[-1] + 0.1))
    return np.interp(time, *_oscillation(end, frequency, upper, lower, natural_hz, damping_ratio, slope))


def box_voltage(time: np.ndarray, frequency: float, voltage: float) -> np.ndarray:
    """Voltages [V] [n, 2] of the alternating box drive."""
    side = _box(time, frequency, 1.0, 1.0)
    return voltage * np.column_stack([side > 0, side < 0]).astype(float)


@pytest.fixture
def angle() -> Callable[..., np.ndarray]:
    """The oscillator's angle as a function of time and its properties."""
    return oscillator_angle


@pytest.fixture
def made_run() -> Callable[..., RunSeries]:
    """Make a run whose measured series is `change(time, simulated, truth)` of the simulated one plus noise.

    truth(time, **properties) gives the oscillator's angle for the run's frequency.
    """

    def make(
        change=lambda time, simulated, truth: simulated,
        frequency: float = 2.0,
        voltage: float = 4500.0,
        periods: float = 4.0,
        noise: float = 0.002,
        seed: int = 0,
        name: str = "run",
    ) -> RunSeries:
        time = np.arange(0, periods / frequency, 1 / FRAME_RATE)

        def truth(at: np.ndarray, **properties: float) -> np.ndarray:
            return oscillator_angle(at, frequency, **properties)

        simulated = truth(time)
        measured = change(time, simulated, truth) + noise * np.random.default_rng(seed).normal(size=len(time))
        return RunSeries(name, time, measured, simulated, time, box_voltage(time, frequency, voltage))

    return make


@pytest.fixture
def made_recording() -> Callable[..., Recording]:
    """Make a clean recording of the oscillator: frames, box drive and angle with noise."""

    def make(frequency: float = 2.0, voltage: float = 4500.0, seed: int = 0, **fields) -> Recording:
        time = np.arange(0, 4 / frequency, 1 / FRAME_RATE)
        noise = 0.002 * np.random.default_rng(seed).normal(size=len(time))
        own = {
            "name": "run",
            "time_s": time,
            "sin_theta": oscillator_angle(time, frequency) + noise,
            "drive_signal": box_voltage(time, frequency, voltage),
        }
        return Recording(**{**own, **fields})

    return make


def _shared_data(folder: str) -> Path:
    for parent in Path(__file__).resolve().parents:
        for place in (parent / "data" / folder, parent / "shared" / "data" / folder):
            if place.is_dir():
                return place
    pytest.skip(f"the data folder {folder} is not here; see the README for where it comes from")


@pytest.fixture(scope="session")
def unseen_rig() -> Path:
    """Folder with runs of the swimmer from an independent simulator."""
    return _shared_data("unseen_rig")


@pytest.fixture
def real_beam() -> Path:
    """Folder with the measured swing of a clamped silicone beam."""
    return _shared_data("real_beam")


@pytest.fixture(scope="session")
def bent_swimmer() -> tuple[Problem, Evaluation]:
    """A coarse swimmer that is bent once, against an angle that it does not follow; not fitted."""
    time = np.arange(0.0, 0.3, 1 / 60)
    schedule = DriveSchedule(np.zeros(1), np.array([[4500.0, 0.0]]))
    measured = Recording("bent", time, 0.2 * time, drive_signal=schedule.at(time))
    problem = Problem([Experiment(measured, Run("bent", time, schedule))], SerialExecutor())
    model = load_model("swimmer").with_levels([4500.0]).with_values({"amplitude_4500": 0.03})
    model = model.with_numerics(mesh_density=0.5, quadrature_order=2, steps_per_second=120.0)
    return problem, problem.evaluate(model, ("amplitude_4500", "slope"))
