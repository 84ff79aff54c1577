# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The error by stage and the runs as pictures, vector or PNG, for a paper, a README or slides."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")  # no display is needed to write a file

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from hasel_sysid.report.content import ReportContent, RunOverlay, StageRow, known_errors
from hasel_sysid.report.style import DROP, FITTED, MEASURED, MODELS, NOISE, OF_RUNS, RISE, UNSEEN, bare
from hasel_sysid.report.wording import change_text, error_text

_DOTS_PER_INCH = 150
_BESIDE = 4
plt.rcParams["svg.fonttype"] = "none"  # text stays text: it can be found, and set in the paper's own font


def vector_figures(content: ReportContent, folder: Path) -> list[Path]:
    """Write the figures of a report as SVG into its folder `figures`; returns what was written."""
    folder = folder / "figures"
    written = [overlay_picture(content.runs, folder / "runs.svg")] if content.runs else []
    if content.stages:
        written.append(waterfall_picture(content.stages, content.noise_floor, folder / "waterfall.svg"))
        written.append(stages_picture(content.stages, content.noise_floor, folder / "error_by_stage.svg"))
    return written


def waterfall_picture(stages: Sequence[StageRow], noise_floor: float | None, path: Path) -> Path:
    """Draw the error waterfall on fitted and, where there are any, on unseen runs."""
    groups = known_errors(stages)
    figure, axes = plt.subplots(1, len(groups), figsize=(4.6 * len(groups), 3.4), sharey=True, squeeze=False)
    for axis, (name, known) in zip(axes[0], groups.items(), strict=True):
        _waterfall(axis, known, OF_RUNS[name])
        _noise(axis, noise_floor)
        if noise_floor is not None:
            axis.legend(frameon=False, loc="upper right", fontsize=8)
        axis.set_title(name, fontsize=11)
    axes[0][0].set_ylabel("mean |Δ sin θ|")
    return _save(figure, path)


def stages_picture(stages: Sequence[StageRow], noise_floor: float | None, path: Path) -> Path:
    """Draw the error of every stage as bars, fitted beside unseen runs."""
    figure, axis = plt.subplots(figsize=(1.6 + 1.5 * len(stages), 3.2))
    place = np.arange(len(stages))
    for shift, name, errors, colour in (
        (-0.2, "fitted runs", [s.error for s in stages], FITTED),
        (0.2, "unseen runs", [s.error_unseen for s in stages], UNSEEN),
    ):
        if all(error is None for error in errors):
            continue
        heights = [np.nan if error is None else error for error in errors]
        bars = axis.bar(place + shift, heights, 0.38, color=colour, label=name)
        axis.bar_label(bars, ["" if np.isnan(h) else error_text(h) for h in heights], padding=2, fontsize=8)
    _noise(axis, noise_floor)
    axis.set_xticks(place, [stage.label for stage in stages])
    axis.set_ylabel("mean |Δ sin θ|")
    axis.legend(frameon=False)
    bare(axis)
    return _save(figure, path)


def overlay_picture(runs: Sequence[RunOverlay], path: Path) -> Path:
    """Draw measured against simulated angle of some runs, up to four side by side."""
    beside = min(_BESIDE, len(runs))
    rows = -(-len(runs) // beside)
    size = (3.6 * beside, 0.4 + 2.4 * rows)
    figure, axes = plt.subplots(rows, beside, figsize=size, sharey=True, squeeze=False)
    for axis in axes.flat[len(runs) :]:
        axis.set_visible(False)
    for axis, run in zip(axes.flat, runs, strict=False):
        axis.plot(run.time, run.measured, ".", color=MEASURED, markersize=2.5, label="measured")
        for number, (label, simulated) in enumerate(run.simulated.items()):
            axis.plot(run.time, simulated, color=MODELS[number % len(MODELS)], linewidth=1.3, label=label)
        axis.set_title(run.name + (" (unseen)" if run.unseen else ""), fontsize=10)
        axis.set_xlabel("time [s]")
        bare(axis)
    for axis in axes[:, 0]:
        axis.set_ylabel("sin θ")
    figure.legend(*axes[0][0].get_legend_handles_labels(), frameon=False, ncols=4, loc="outside lower center")
    return _save(figure, path)


def _waterfall(axis: Axes, known: Sequence[tuple[str, float]], colour: str) -> None:
    labels, errors = [label for label, _ in known], [error for _, error in known]

    def write(text: str, place: int, height: float, weight: str = "normal") -> None:
        where = (place, height), (0, 3)
        axis.annotate(text, *where, textcoords="offset points", ha="center", fontsize=8, weight=weight)

    axis.bar(0, errors[0], 0.75, color=colour)
    write(error_text(errors[0]), 0, errors[0])
    for place, (before, after) in enumerate(zip(errors, errors[1:], strict=False), start=1):
        falls = after <= before
        axis.bar(place, before - after, 0.75, bottom=after, color=DROP if falls else RISE)
        axis.plot([place - 1.375 + 0.75, place + 0.375], [before, before], color="#c3c9cf", linewidth=0.8)
        write(change_text(after - before), place, max(before, after))
    end = len(errors)
    axis.bar(end, errors[-1], 0.75, color=colour)
    write(error_text(errors[-1]), end, errors[-1], weight="bold")
    axis.set_xticks(range(end + 1), [*labels, "left over"], rotation=20, ha="right")
    axis.set_ylim(0, 1.12 * max(errors))
    bare(axis)


def _noise(axis: Axes, noise_floor: float | None) -> None:
    if noise_floor is not None:
        label = f"noise floor {error_text(noise_floor)}"
        axis.axhline(noise_floor, color=NOISE, linestyle="--", linewidth=1.0, label=label)


def _save(figure: plt.Figure, path: Path) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.set_layout_engine("constrained")
    figure.savefig(path, dpi=_DOTS_PER_INCH)
    plt.close(figure)
    return path
