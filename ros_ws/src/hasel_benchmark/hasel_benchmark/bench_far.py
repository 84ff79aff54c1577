# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bench_far`: is a gross constant that is far off named, or put into the stated group?

It is wrong by so much that the body rings at another frequency.
"""

import argparse
import time
from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from hasel_bringup.hidden_truth.truth import NOMINAL, NUMERICS, truth_model
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, load_model
from hasel_sim.parallel import executor, simulate_all
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from hasel_sysid.experiment import Experiment
from hasel_sysid.residual_analysis.swing import fit_swing
from scipy.optimize import brentq

from hasel_benchmark.bench_hidden.laboratory import seen
from hasel_benchmark.bench_hidden.run_cases import answer
from hasel_benchmark.benchmark_commands import BODIES, SIZES, told
from hasel_benchmark.errors import BenchmarkError

NOISES = (2e-5, 3e-4, 3e-3)
_BEAM_DAMPING_S = 0.004
_FRAMES_PER_SECOND = 100.0


@dataclass(frozen=True)
class FarCase:
    """effect: the wrong constant; shift: of the ringing's frequency, as a share; body: beam (let go) or swimmer
    (driven); noise: rms of sin theta, white.
    """

    effect: str
    shift: float
    body: str
    noise: float
    seed: int = 0

    @property
    def name(self) -> str:
        """Such as `payload-0.4-beam-2e-05`."""
        return f"{self.effect}{self.shift:+g}-{self.body}-{self.noise:g}-{self.seed}"


def far_cases(effects: Sequence[str], shifts: Sequence[float], bodies: Sequence[str]) -> list[FarCase]:
    """All of them that a value within the effect's plausible range brings about; the noise goes round."""
    found = []
    for number, (effect, shift) in enumerate((e, s) for e in effects for s in shifts):
        for offset, body in enumerate(BODIES):
            case = FarCase(effect, shift, body, NOISES[(number + offset) % len(NOISES)])
            if body not in bodies or (body == "beam" and effect == "spine_modulus"):
                continue
            if value_of(case) is not None:
                found.append(case)
    return found


def baseline(body: str) -> Model:
    """The model that the search begins with."""
    model = load_model(body)
    if body == "beam":
        soft = model.description.material.soft.model_copy(update={"retardation_time_s": _BEAM_DAMPING_S})
        material = model.description.material.model_copy(update={"soft": soft})
        return type(model)(model.description.model_copy(update={"material": material}))
    return model


def value_of(case: FarCase) -> float | None:
    """The value that shifts the ringing by the case's share; None where no plausible one does."""
    model = _quick(_with_muscles(case.body)).with_effects(case.effect)
    parameter = model.parameters[SIZES[case.effect]]
    null = 1.0 if parameter.lower > 0 else 0.0
    before = ringing_frequency(model.with_values({parameter.name: null}))

    def miss(value: float) -> float:
        return ringing_frequency(model.with_values({parameter.name: value})) / before - 1.0 - case.shift

    if parameter.lower > 0:
        ends = np.geomspace(parameter.lower, parameter.upper, 9)
    else:
        ends = np.concatenate([[0.0], np.geomspace(1e-4, 1.0, 13) * parameter.upper])
    misses = []
    for value in ends:
        try:
            misses.append(miss(float(value)))
        except SimulationError:
            misses.append(np.nan)
    for (a, b), (x, y) in zip(pairwise(misses), pairwise(ends), strict=True):
        if a * b < 0:
            return float(brentq(miss, x, y, rtol=1e-3))
    return None


def ringing_frequency(model: Model) -> float:
    """Frequency [Hz] at which the body swings freely after it was let go, or after a muscle pulled for a moment."""
    time = np.arange(0.0, 2.0, 1 / _FRAMES_PER_SECOND)
    run = Run("ringing", time, None, "static_equilibrium", 1.3)
    if model.has_muscles:
        run = Run("ringing", time, DriveSchedule(np.array([0.0, 0.1]), np.array([[5000.0, 0.0], [0.0, 0.0]])))
    series = simulate(model, run).sin_theta
    swing = fit_swing(time[15:], series[15:])
    return np.nan if swing is None else swing.frequency


def measure(case: FarCase, value: float, pool: Executor) -> tuple[list[Experiment], list[Experiment]]:
    """Fitted and unseen runs of the truth, on another mesh and time step than the model's, with noise and offsets."""
    truth = _with_muscles(case.body)
    truth = NUMERICS["near"].applied(truth).with_effects(case.effect).with_values({SIZES[case.effect]: value})
    runs = swings() if case.body == "beam" else _boxes()
    generator = np.random.default_rng([case.seed, int(1e4 * (1 + case.shift)), len(case.effect)])
    found = observed(truth, runs, case.noise, generator, pool)
    return found[:-1], found[-1:]


def observed(
    truth: Model, runs: Sequence[Run], noise_level: float, generator: np.random.Generator, pool: Executor
) -> list[Experiment]:
    """What a camera measures of a truth's runs: with white noise of this rms, and an offset of each run."""
    found = []
    for run, simulation in zip(runs, simulate_all(pool, truth, runs), strict=True):
        noise = noise_level * generator.standard_normal(len(run.time)) + 0.01 * generator.standard_normal()
        found.append(seen(run, simulation.sin_theta + noise))
    return found


def swings() -> list[Run]:
    """A beam let go from under 1.3 to 1.6 times its loads."""
    time = np.arange(0.0, 2.5, 1 / _FRAMES_PER_SECOND)
    return [Run(f"let go from {f:g}", time, None, "static_equilibrium", f) for f in (1.3, 1.6, 1.45)]


def _boxes() -> list[Run]:
    runs = []
    for voltage, frequency in ((3500.0, 0.5), (5500.0, 2.0), (4500.0, 1.0)):
        time = np.arange(0.0, 2 / frequency, 1 / _FRAMES_PER_SECOND)
        switches = np.arange(4) / (2 * frequency)
        upper = np.arange(4) % 2 == 0
        drive = DriveSchedule(switches, np.where(np.stack([upper, ~upper], axis=1), voltage, 0.0))
        runs.append(Run(f"{voltage:g} V, {frequency:g} Hz", time, drive))
    return runs


def _with_muscles(body: str) -> Model:
    return truth_model(NUMERICS["near"], NOMINAL) if body == "swimmer" else baseline(body)


def _quick(model: Model) -> Model:
    return model.with_numerics(mesh_density=0.5, quadrature_order=2, steps_per_second=120.0)


@dataclass(frozen=True)
class FarOutcome:
    """named: whether the truth is among what was added; grouped: or stated to look like one of that; sure: whether the
    model is said to explain what was seen.
    """

    case: str
    value: float
    missing: tuple[str, ...]
    named: bool
    grouped: bool
    sure: bool
    mae_unseen: float
    seconds: float

    @property
    def right(self) -> bool:
        """Named, or within the stated group."""
        return self.named or self.grouped

    def __str__(self) -> str:
        words = {
            "named": self.named,
            "in the group": self.grouped,
            "WRONG AND SURE": self.sure,
            "missed": True,
        }
        word = next(word for word, holds in words.items() if holds)
        added = " + ".join(self.missing) or "nothing"
        return (
            f"{self.case}: {word} (added {added}; unseen error {self.mae_unseen:.5f}; {self.seconds:.0f} s)"
        )


def run_case(case: FarCase, pool: Executor, only: Sequence[str] | None = None) -> FarOutcome:
    """What `improve` says of one case. only: names of the candidate effects (default: all)."""
    value = value_of(case)
    if value is None:
        raise BenchmarkError(
            f"{case}: no plausible value of {case.effect} shifts the ringing so far; choose another shift."
        )
    fitted, unseen = measure(case, value, pool)
    started = time.monotonic()
    found = answer(baseline(case.body), fitted, unseen, pool, only)
    missing, groups = found["verdict"]["missing"], found["indistinguishable"]
    added = found["stages"][-1]["effects"]
    named = case.effect in added
    return FarOutcome(
        case.name,
        value,
        tuple(added),
        named,
        any(case.effect in group and set(added) & set(group) for group in groups),
        found["verdict"]["status"] == "explained" and case.effect not in missing,
        found["stages"][-1]["mae_validation"],
        time.monotonic() - started,
    )


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    cases = far_cases(options.effects, options.shifts, BODIES if options.body is None else (options.body,))
    with executor(options.jobs) as pool:
        outcomes = told((run_case(case, pool, options.candidates) for case in cases), options.json)
    right, sure = sum(o.right for o in outcomes), sum(o.sure and not o.right for o in outcomes)
    print(
        f"{right} of {len(outcomes)} right or in the stated group (bar: 90 %), {sure} wrong and sure (bar: 0)"
    )
    return 0
