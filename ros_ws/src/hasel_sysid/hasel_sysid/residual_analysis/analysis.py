# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where a model fails: run by run, in all runs together, and in which part of the cycle."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hasel_sysid.residual_analysis.component import Component, Failure, Kind, words
from hasel_sysid.residual_analysis.residual_tests import (
    DriveDependence,
    PhaseProfile,
    Whiteness,
    drive_dependence,
    phase_profile,
    whiteness,
)
from hasel_sysid.residual_analysis.robust_statistics import high_frequency_noise, pool, standing_out
from hasel_sysid.residual_analysis.run_series import RunSeries
from hasel_sysid.residual_analysis.split import split

_CLEAR = 4.0
_SHARE_OF_NOISE = 0.75
_CLEAR_IN_ALL = 3.0
ALL_RUNS = "all runs"
_STANDS_OUT = 1.5
_MOST_SINGLE = 6


@dataclass(frozen=True)
class RunAnalysis:
    """components: largest first; failures: those that are clear; noise: rms of sin theta from the fastest part."""

    run: RunSeries
    components: tuple[Component, ...]
    failures: tuple[Failure, ...]
    profile: PhaseProfile | None
    whiteness: Whiteness | None
    drive_dependence: DriveDependence | None
    noise: float


def analyse_run(run: RunSeries) -> RunAnalysis:
    """Split a run's residual and test what is left.

    A component is a failure when it is four standard errors from zero and accounts for more than three quarters of the
    noise; the offset only counts in comparison with other runs.
    """
    components, noise = split(run), high_frequency_noise(run.measured)
    failures = tuple(
        Failure(c, run.name)
        for c in components
        if c.kind is not Kind.OFFSET and c.size > _SHARE_OF_NOISE * noise and c.significance > _CLEAR
    )
    return RunAnalysis(
        run,
        components,
        failures,
        phase_profile(run),
        whiteness(run.residual, run.frame_time),
        drive_dependence(run),
        noise,
    )


def failures_in_all_runs(
    runs: Sequence[RunSeries], components: Sequence[Sequence[Component]], noise: float
) -> list[Failure]:
    """Components that are clear over all runs, or clear in one condition, largest first.

    components: of each run; noise: rms of sin theta below which nothing is reported.
    """
    found = []
    for kind in Kind:
        pairs = [
            (run, c) for run, parts in zip(runs, components, strict=True) for c in parts if c.kind is kind
        ]
        if len(pairs) > 1:
            failure = _failure(kind, [p[0] for p in pairs], [p[1] for p in pairs], noise)
            found += [] if failure is None else [failure]
    return sorted(found, key=lambda failure: -failure.size)


def _failure(kind: Kind, runs: list[RunSeries], parts: list[Component], noise: float) -> Failure | None:
    size = float(np.sqrt(np.mean([c.size**2 for c in parts])))
    if size < noise:
        return None
    values, errors = [c.value for c in parts], [c.standard_error for c in parts]
    whole = pool(values, errors)
    remarks = _conditions(runs, values, errors)
    if _disagree(values, errors):
        return None if kind is Kind.RINGING else _opposed(runs, parts)
    if abs(whole.mean) < _CLEAR_IN_ALL * whole.standard_error and not remarks:
        return None
    if kind is Kind.OFFSET and whole.scatter > whole.standard_error:
        remarks.append("not alike in all runs as that of a camera or a marker would be")
    details = [c.detail for c in parts if c.detail]
    detail = {name: float(np.median([d[name] for d in details])) for name in details[0]} if details else None
    component = Component(kind, whole.mean, whole.standard_error, parts[0].unit, size, detail)
    return Failure(component, ALL_RUNS, ", ".join(remarks))


def _conditions(runs: list[RunSeries], values: list[float], errors: list[float]) -> list[str]:
    """At which frequency and which level of the drive the value stands out."""
    frequencies = [float(f"{run.frequency:.2g}") for run in runs]
    levels = [float(f"{run.level:.4g}") for run in runs]
    labels = dict(zip(levels, (run.level_text for run in runs), strict=True))
    frequency = standing_out(frequencies, values, errors)
    level = standing_out(levels, values, errors)
    found = [f"more at {frequency:g} Hz"] if frequency else []
    return found + ([f"more at {labels[level]}"] if level else [])


def _disagree(values: list[float], errors: list[float]) -> bool:
    """Whether clear values of both signs occur, the rarer sign in more than a fifth of the clear runs."""
    clear = [
        value > 0 for value, error in zip(values, errors, strict=True) if abs(value) > _CLEAR_IN_ALL * error
    ]
    return len(clear) > 0 and 0.2 < sum(clear) / len(clear) < 0.8


def _opposed(runs: list[RunSeries], parts: list[Component]) -> Failure:
    """The run with the largest size, and the one that goes furthest the other way."""
    largest = max(range(len(parts)), key=lambda n: parts[n].size)
    sign = np.sign(parts[largest].value)
    other = min(range(len(parts)), key=lambda n: sign * parts[n].value)
    return Failure(parts[largest], runs[largest].name, f"but {words(parts[other])} in {runs[other].name}")


@dataclass(frozen=True)
class WhereItFails:
    """runs: analysis of each run; failures: what many runs have in common, largest first.

    phase [bins] with profile [bins]: residual by phase of the cycle, mean magnitude over the runs relative to each
    run's own mean; empty without a cycle.
    """

    runs: tuple[RunAnalysis, ...]
    failures: tuple[Failure, ...]
    phase: np.ndarray
    profile: np.ndarray

    @property
    def noise(self) -> float:
        """Median over the runs of the noise in sin theta."""
        return float(np.median([run.noise for run in self.runs])) if self.runs else 0.0

    def sentences(self) -> list[str]:
        """What a researcher would say, most important first; single runs only where the runs have nothing in common."""
        single = [failure for run in self.runs for failure in run.failures]
        said = [str(f) for f in self.failures or sorted(single, key=lambda f: -f.size)[:_MOST_SINGLE]]
        worst = self._worst_phase()
        said += [] if worst is None else [worst]
        return said or ["No systematic difference stands out from the noise."]

    def _worst_phase(self) -> str | None:
        if len(self.profile) == 0 or np.nanmax(self.profile) < _STANDS_OUT * np.nanmean(self.profile):
            return None
        at = float(self.phase[int(np.nanargmax(self.profile))])
        run, side = next(
            (each.run, each.run.cycle.side)
            for each in self.runs
            if each.profile is not None and each.run.cycle is not None
        )
        one, other = _channel_names(run)
        first, second = (one, other) if side[0] > 0 else (other, one)
        alternates = bool(np.any(side != side[0]))
        muscle, since = (second, at - 0.5) if alternates and at >= 0.5 else (first, at)
        return (
            f"The error is largest {100 * since:.0f} % of a cycle after {muscle} is switched on, "
            f"{np.nanmax(self.profile):.1f} times its mean."
        )

    def __str__(self) -> str:
        return "\n".join(self.sentences())


def _channel_names(run: RunSeries) -> tuple[str, str]:
    """What a sentence calls the first channel and the other one."""
    names = [
        f"the {c.name} muscle" if c.quantity == "voltage" else f"the {c.quantity} of {c.name}"
        for c in run.channels
    ]
    return names[0], names[1] if len(names) == 2 else "another channel"


def where_it_fails(runs: Sequence[RunSeries]) -> WhereItFails:
    """Analyse runs that were simulated with one model."""
    analyses = tuple(analyse_run(run) for run in runs)
    noise = float(np.median([a.noise for a in analyses])) if analyses else 0.0
    failures = failures_in_all_runs(runs, [a.components for a in analyses], _SHARE_OF_NOISE * noise)
    profiles = [a.profile for a in analyses if a.profile is not None]
    if not profiles:
        return WhereItFails(analyses, tuple(failures), np.zeros(0), np.zeros(0))
    relative = [p.absolute / max(float(np.nanmean(p.absolute)), 1e-12) for p in profiles]
    known = np.ma.masked_invalid(relative)  # at few frames a cycle there are phases without any
    return WhereItFails(analyses, tuple(failures), profiles[0].phase, known.mean(axis=0).filled(np.nan))
