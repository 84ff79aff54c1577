# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From a case to what a laboratory would have measured."""

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from hasel_bringup.hidden_truth.plan import FITTED, UNSEEN, BoxRun
from hasel_bringup.hidden_truth.truth import NUMERICS, Muscles, draw_muscles, truth_model
from hasel_recording import Recording, write_recording
from hasel_sim.effects.registry import find_effects
from hasel_sim.errors import SimulationError
from hasel_sim.parallel import simulate_all
from hasel_sim.run import Run, Simulation
from hasel_sysid.experiment import Experiment
from scipy.signal import lfilter

from hasel_benchmark.bench_hidden.hidden_cases import FAULTS, Case, draw_values, effect_source

NOISE_RMS = 0.003
"""Of sin theta, as on the rig."""
COLOURS = {"white": 0.0, "coloured": 0.9}
"""Correlation of neighbouring frames (first-order autoregressive)."""
_OFFSET_RMS = 0.005
"""How far the camera stands turned from run to run [sin theta]."""
Values = dict[str, dict[str, float]]
_WEAKER = 6
"""How often a strong effect is halved until its truth can be simulated."""


@dataclass(frozen=True)
class Laboratory:
    """What was measured, and what only the benchmark knows.

    values: of the hidden effects' parameters; floor_*: mean |noise| with every run's mean removed, what a perfect
    model would leave.
    """

    fitted: tuple[Experiment, ...]
    unseen: tuple[Experiment, ...]
    values: dict[str, dict[str, float]]
    floor_fitted: float
    floor_unseen: float

    def write(self, folder: Path) -> None:
        """Write every run to a CSV file of its name; it holds exact switches only if they lie on frames."""
        folder.mkdir(parents=True, exist_ok=True)
        for measured in (*self.fitted, *self.unseen):
            write_recording(measured.recording, folder / f"{measured.name}.csv")


def measure(
    case: Case,
    pool: Executor,
    switch_on_frames: bool = False,
    fitted: Sequence[BoxRun] = FITTED,
    unseen: Sequence[BoxRun] = UNSEEN,
) -> Laboratory:
    """Simulate the truth of a case and add noise.

    switch_on_frames: let the drive switch at frames only, which is what CSV files can hold.
    Raises SimulationError when this truth cannot be simulated.
    """
    generator = case.generator()
    muscles = draw_muscles(generator)
    values = draw_values(case, generator)
    runs = [box.run(switch_on_frames) for box in (*fitted, *unseen)]
    fault = FAULTS[case.fault] if case.fault else None
    names = [run.name for run in runs]
    faulty = fault.runs(names[: len(fitted)], names, generator) if fault else set()
    driven = [fault.drives(run) if fault and run.name in faulty else run for run in runs]
    values, simulations = _as_far_as_it_goes(case, values, muscles, driven, pool)
    noises = [draw_noise(len(run.time), case.colour, generator) for run in runs]
    measured = []
    for run, simulation, noise in zip(runs, simulations, noises, strict=True):
        sign = fault.sign if fault and run.name in faulty else 1.0
        angle = sign * simulation.sin_theta + noise + _OFFSET_RMS * generator.standard_normal()
        measured.append(seen(run, angle, exact_switches=not switch_on_frames))
    split = len(fitted)
    return Laboratory(
        tuple(measured[:split]),
        tuple(measured[split:]),
        values,
        _mean_absolute(noises[:split]),
        _mean_absolute(noises[split:]),
    )


def draw_noise(frames: int, colour: str, generator: np.random.Generator) -> np.ndarray:
    """Stationary measurement noise of sin theta, [frames]."""
    correlation = COLOURS[colour]
    drive = generator.standard_normal(frames)
    drive[1:] *= np.sqrt(1 - correlation**2)
    return NOISE_RMS * lfilter([1.0], [1.0, -correlation], drive)


def _mean_absolute(series: list[np.ndarray]) -> float:
    return float(np.abs(np.concatenate([part - part.mean() for part in series])).mean()) if series else 0.0


def _as_far_as_it_goes(
    case: Case, values: Values, muscles: Muscles, runs: Sequence[Run], pool: Executor, left: int = _WEAKER
) -> tuple[Values, list[Simulation]]:
    """What is hidden and the truth's motion; what is strong is as strong as can be simulated."""
    hidden = {effect_source(identity): chosen for identity, chosen in values.items()}
    model = truth_model(NUMERICS[case.numerics], muscles, hidden)
    try:
        return values, simulate_all(pool, model, runs)
    except SimulationError:
        if case.kind != "strong" or not left:
            raise
    weaker = {identity: _half(identity, chosen) for identity, chosen in values.items()}
    return _as_far_as_it_goes(case, weaker, muscles, runs, pool, left - 1)


def _half(identity: str, values: dict[str, float]) -> dict[str, float]:
    """Sizes half as far from doing nothing."""
    sizes = {p.name: p.null for p in find_effects((identity,))[0].parameters if not p.scan}
    return {name: 0.5 * (value + sizes[name]) if name in sizes else value for name, value in values.items()}


def seen(run: Run, sin_theta: np.ndarray, exact_switches: bool = False) -> Experiment:
    """A run as it is recorded: with the drive at the frames, or also at the instants at which it switched."""
    drive = run.schedule
    exact = drive if exact_switches else None
    recording = Recording(
        run.name,
        run.time,
        sin_theta,
        drive_signal=None if drive is None else drive.at(run.time),
        drive_time_s=None if exact is None else exact.time,
        drive_values=None if exact is None else exact.signal,
    )
    return Experiment(recording, run)
