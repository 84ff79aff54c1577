# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The report's content from a comparison or a fit."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from hasel_sim.model import Model

from hasel_sysid.comparison import Comparison, RunComparison
from hasel_sysid.report.content import KeyNumber, ParameterRow, ReportContent, RunOverlay
from hasel_sysid.report.overlay import driven_stretches
from hasel_sysid.report.shape import Shapes, simulated_shapes
from hasel_sysid.report.wording import count_text, error_text, meaning, plausible, remark

if TYPE_CHECKING:
    from hasel_sysid.estimation import FittedModel

_RMS_TO_MEAN = 0.798
"""Mean magnitude of Gaussian noise of unit standard deviation."""


def overlays(comparisons: Sequence[Comparison]) -> tuple[RunOverlay, ...]:
    """Measured angle of every run with what each model says, each run's offset taken out of the measurement."""
    shown = []
    for index, run in enumerate(comparisons[0].runs):
        series = run.series
        simulated = {
            c.label: c.runs[index].series.simulated + c.runs[index].series.offset - series.offset
            for c in comparisons
            if len(c.runs[index].series.time) == len(series.time)
        }
        shown.append(
            RunOverlay(
                run.name,
                series.time,
                series.measured - series.offset,
                simulated,
                run.unseen,
                series.level_text if series.level else "",
                series.frequency,
                ()
                if series.drive is None
                else driven_stretches(*series.drive, series.time[0], series.time[-1]),
            )
        )
    return tuple(shown)


def parameter_rows(
    model: Model, remarks: dict[str, str] | None = None, before: Model | None = None
) -> tuple[ParameterRow, ...]:
    """Every parameter of a model; remarks by name; before: the model that it is to be compared with."""
    earlier = {} if before is None else before.values
    return tuple(
        ParameterRow(
            p.name,
            p.value,
            p.standard_error,
            p.unit,
            (remarks or {}).get(p.name) or remark(p.name, model),
            meaning(p.name, model),
            plausible(p.name, model),
            earlier.get(p.name),
        )
        for p in model.parameters.values()
    )


def never_fitted(label: str, model: Model) -> str:
    """A sentence that must come first, of a model whose numbers are first guesses; empty for any other."""
    known = len(model.levels) and model.description.muscle is None
    fitted = known or any(p.standard_error is not None for p in model.parameters.values())
    if fitted or not model.free:
        return ""
    return (
        f"model '{label}' was never fitted to any recording, so amplitudes and other free values are first guesses: "
        "run fit to learn how well it can do"
    )


def comparison_content(
    comparisons: Sequence[Comparison],
    first_of_all: Sequence[str] = (),
    detailed: int = 0,
    shapes_of: Callable[[Model, Sequence[RunComparison]], Shapes | None] = simulated_shapes,
) -> ReportContent:
    """Report of one or several models against the same recordings; one of them in detail.

    first_of_all: what must be known before any number is read; shapes_of: who simulates the body's extreme shapes.
    """
    first = comparisons[0]
    labels = ", ".join(c.label for c in comparisons)
    frames = sum(len(run.series.time) for run in first.runs)
    return ReportContent(
        title=f"{labels} against {count_text(len(first.runs), 'recording')}",
        subtitle=f"{frames} frames; errors are mean |Δ sin θ| with each run's offset taken out",
        verdict=first.where.sentences()[0],
        good=not first.where.failures and not any(run.analysis.failures for run in first.runs),
        key_numbers=key_numbers(first),
        runs=overlays(comparisons),
        comparisons=tuple(comparisons),
        detailed=detailed,
        shapes=shapes_of(comparisons[detailed].model, first.runs),
        first_of_all=tuple(f"{sentence[:1].upper()}{sentence[1:]}." for sentence in first_of_all if sentence),
        recordings=tuple(f"{run.name}{' (unseen)' if run.unseen else ''}" for run in first.runs),
        parameters=parameter_rows(first.model),
    )


def key_numbers(comparison: Comparison) -> tuple[KeyNumber, ...]:
    """Error on fitted and unseen runs, of the speed where a body swims, and the noise."""
    numbers = []
    if comparison.mean_absolute_error is not None:
        fitted = sum(not run.unseen for run in comparison.runs)
        numbers.append(
            KeyNumber(error_text(comparison.mean_absolute_error), "mean |Δ sin θ|", count_text(fitted, "run"))
        )
    if comparison.mean_absolute_error_unseen is not None:
        unseen = sum(run.unseen for run in comparison.runs)
        numbers.append(
            KeyNumber(
                error_text(comparison.mean_absolute_error_unseen),
                "on unseen runs",
                f"{count_text(unseen, 'run')}, never fitted",
            )
        )
    if comparison.mean_speed_error is not None:
        swimming = sum(run.speed is not None for run in comparison.runs)
        numbers.append(
            KeyNumber(
                f"{1e3 * comparison.mean_speed_error:.3g} mm/s",
                "mean |Δ speed|",
                f"swimming, {count_text(swimming, 'run')}",
            )
        )
    noise = _RMS_TO_MEAN * comparison.where.noise
    numbers.append(KeyNumber(error_text(noise), "noise floor", "from the fastest part of the measured angle"))
    return tuple(numbers)


def fit_content(result: "FittedModel", comparison: Comparison) -> ReportContent:
    """Report of a fit: the comparison, with parameters, their uncertainty and alarms."""
    remarks = dict.fromkeys(result.at_bound, "on its bound")
    remarks |= dict.fromkeys(result.undetermined, "not determined by these recordings")
    content = comparison_content([comparison])
    return replace(
        content,
        title=f"{comparison.label}: {count_text(len(comparison.runs), 'recording')}",
        verdict=str(comparison),
        good=None,
        parameters=parameter_rows(result.model, remarks),
        messages=tuple(result.sentences),
    )
