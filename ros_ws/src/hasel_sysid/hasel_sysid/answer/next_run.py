# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The next experiment: which of a small library of safe ones would make the remaining explanations differ most.

Experiments are in the words of the RunExperiment action, differences in units of the noise.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import Any

import numpy as np
from hasel_common.progress import Workload
from hasel_recording import HASEL_PAIR, DriveChannel
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import HaselSimError, SimulationError
from hasel_sim.model import Model
from hasel_sim.run import Run
from hasel_sim.simd import LANES
from hasel_sim.simulate import simulate_many

from hasel_sysid.answer.diagnosis import Diagnosis
from hasel_sysid.dataset import model_channels
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation.least_squares import minimise
from hasel_sysid.expected_work import NEXT_RUNS, work_of
from hasel_sysid.noise import NoiseModel
from hasel_sysid.problem import Problem, low_fidelity

_FRAME_RATE = 120.0
_RATES_HZ = (0.25, 0.5, 1.0, 1.5, 2.5, 3.5, 5.0)
_PERIODS, _LONGEST_S = 3, 6.0
_LOAD_FACTORS = (0.25, 0.5, 1.0, 2.0, 3.0)
_BRIEF = 8
"""Evaluations for a fit of what the diagnosis did not think worth one."""


@dataclass(frozen=True)
class Manoeuvre:
    """One experiment. voltage: largest value of the drive, in the unit of its channels; frequency [1/s]; waveform: box,
    triangle or sine; muscles: both (all channels in turn) or the name of one.

    Each channel is driven for its share of the period, with positive values only, which every supply can give; one
    alone has the first half.

    load_factor: for a passive body, how many times its loads it is held under before it is let go; channels: what
    drives the body, all of one unit.
    """

    voltage: float
    frequency: float
    periods: int
    waveform: str
    muscles: str
    load_factor: float | None = None
    channels: tuple[DriveChannel, ...] = HASEL_PAIR

    def goal(self) -> dict[str, Any]:
        """Fields of a RunExperiment goal; for channels other than the rig's two voltages, the same in their unit."""
        fields = {key: getattr(self, key) for key in ("frequency", "periods", "waveform")}
        if self.channels != HASEL_PAIR:
            driven = [c.column for c in self.channels if self.muscles in ("both", c.name)]
            return {"level": self.voltage, "unit": self.channels[0].unit, **fields, "channels": driven}
        fields |= {"voltage": self.voltage, "muscles": self.muscles}
        return {**fields, "polarity": "positive", "duty": 1.0, "rest_time": 2.0, "output": ""}

    def run(self) -> Run:
        """The run to simulate."""
        if self.load_factor is not None:
            time = np.arange(0.0, 4.0, 1 / _FRAME_RATE)
            return Run(str(self), time, None, "static_equilibrium", self.load_factor)
        duration = self.periods / self.frequency
        time = np.arange(0.0, duration, 1 / _FRAME_RATE)
        return Run(str(self), time, self._schedule(duration))

    def _schedule(self, duration: float) -> DriveSchedule:
        names = [channel.name for channel in self.channels]
        alone = None if self.muscles == "both" else names.index(self.muscles)
        count = 2 if alone is not None else max(2, len(names))
        if self.waveform == "box":
            time = np.arange(0.0, duration - 1e-9, 1 / (count * self.frequency))
            turns = (np.arange(len(time)) % count)[:, None] == np.arange(count)
        else:
            time = np.arange(0.0, duration, 1 / _FRAME_RATE)
            turn = count * ((time * self.frequency) % 1.0)
            share = turn % 1.0
            wave = np.sin(np.pi * share) if self.waveform == "sine" else 1 - np.abs(2 * share - 1)
            turns = wave[:, None] * (np.floor(turn)[:, None] == np.arange(count))
        shape = np.zeros((len(time), len(names)))
        if alone is None:
            shape[:] = turns[:, : len(names)]
        else:
            shape[:, alone] = turns[:, 0]
        return DriveSchedule(time, self.voltage * shape, tuple(names))

    def __str__(self) -> str:
        if self.load_factor is not None:
            return f"hold under {self.load_factor:g} times its loads, let go"
        size = self.channels[0].shown(self.voltage)
        return f"{self.waveform} of {size} at {self.frequency:g} Hz, {self.periods} periods, {self._who()}"

    def _who(self) -> str:
        names = [channel.name for channel in self.channels]
        if self.channels == HASEL_PAIR:
            return "both muscles" if self.muscles == "both" else f"the {self.muscles} muscle only"
        if self.muscles == "both" and len(names) > 1:
            return f"{', '.join(names)} in turn"
        return f"{names[0] if self.muscles == 'both' else self.muscles} only"


def manoeuvres(
    levels: np.ndarray, highest: float, brief: bool = False, channels: tuple[DriveChannel, ...] = HASEL_PAIR
) -> list[Manoeuvre]:
    """All combinations within the safe maximum; levels: those whose amplitudes are known, none: a passive body.

    levels, highest: in the unit of the channels; brief: boxes at the highest of these levels only.
    """
    if len(levels) == 0:
        return [Manoeuvre(0.0, 0.0, 0, "none", "both", factor) for factor in _LOAD_FACTORS]
    voltages = sorted({float(v) for v in (levels[0], levels[-1], min(highest, levels[-1])) if v <= highest})
    waveforms = ("box",) if brief else ("box", "triangle")
    driven = ("both", channels[0].name) if len(channels) > 1 else ("both",)
    return [
        Manoeuvre(
            voltage, rate, max(1, min(_PERIODS, int(_LONGEST_S * rate))), waveform, muscles, channels=channels
        )
        for voltage, rate, waveform, muscles in product(
            voltages[-1:] if brief else voltages, _RATES_HZ, waveforms, driven
        )
    ]


def rivals(diagnosis: Diagnosis, fit: Callable[[Model], Model] | None = None) -> dict[str, Model]:
    """The refitted models of the explanations that are still in the running, at least two, by effect.

    fit: where somebody asked for these effects and one alone is in the running, this fits the next of the ranking, to
    be compared with it all the same. Raises SysidError when there are not two to tell apart.
    """
    fitted = _refitted(diagnosis)
    rest = [finding.effect for finding in diagnosis.findings if finding.effect not in fitted]
    for effect in rest:
        if fit is None or len(fitted) >= 2:
            break
        try:
            fitted[effect] = fit(with_effect(diagnosis.fit.model, diagnosis, effect))
        except HaselSimError:
            continue
    if len(fitted) < 2:
        raise SysidError(
            "fewer than two explanations are left, so there is nothing to tell apart; "
            "name two with --effects to compare them all the same"
        )
    return fitted


def in_doubt(diagnosis: Diagnosis, accepted: Sequence[str]) -> dict[str, Model]:
    """The refitted models that these recordings cannot tell from the first accepted effect's, itself among them.

    Where nothing was accepted, all that were refitted; fewer than two leave nothing to tell apart.
    """
    fitted = _refitted(diagnosis)
    if not accepted:
        return fitted
    group = next((group for group in diagnosis.groups if accepted[0] in group), ())
    return {effect: model for effect, model in fitted.items() if effect in group}


def _refitted(diagnosis: Diagnosis) -> dict[str, Model]:
    return {finding.effect: finding.fit.model for finding in diagnosis.findings if finding.fit is not None}


def fitted_briefly(problem: Problem, model: Model) -> Model:
    """A model fitted to the runs of a problem, as far as a few evaluations lead."""
    return minimise(problem, problem.evaluate(model, model.free), 1e-3, _BRIEF)[0].model


def with_effect(model: Model, diagnosis: Diagnosis, effect: str) -> Model:
    """The model with an effect at a typical size, as none was fitted; raises ModelError where it does not fit in."""
    extended = model.with_effects(diagnosis.finding(effect).source or effect)
    kind = next(each for each in extended.effects if each.id == effect)
    names = [f"{effect}.{parameter.name}" for parameter in kind.parameters]
    return extended.with_values(dict(zip(names, kind.typical().values(), strict=True)))


@dataclass(frozen=True)
class Suggestion:
    """difference: rms difference between the two most similar of the remaining explanations, in units of the noise;
    pairs: the same for every pair of them.
    """

    manoeuvre: Manoeuvre
    difference: float
    pairs: dict[tuple[str, str], float]

    def to_json(self) -> dict[str, Any]:
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
                series = {name: one for name, each in simulated.items() if (one := each[index]) is not None}
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
