# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Pictures of recordings, comparisons, rankings and falling errors, and files that Python's user asks for."""

from collections.abc import Callable, Sequence
from io import BytesIO
from pathlib import Path

import numpy as np
from hasel_common.command_entry import of_system
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hasel_sysid.answer.diagnosis import Diagnosis
from hasel_sysid.answer.result import Stage
from hasel_sysid.comparison import Comparison
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment
from hasel_sysid.report.style import DROP, FITTED, MEASURED, MODELS, NOISE, UNSEEN, bare
from hasel_sysid.report.wording import count_text

_DOTS_PER_INCH = 110
_COLUMNS, _MOST_EFFECTS = 3, 8


def path_of(given: str | Path) -> Path:
    """The path itself. Raises SysidError for what is none."""
    if isinstance(given, (str, Path)):
        return Path(given)
    raise SysidError(
        f"found a {type(given).__name__} where a path is expected: give one such as 'model.yaml'"
    )


def written(path: Path, write: Callable[[Path], object]) -> Path:
    """The path, after `write` was called with it. Raises SysidError for what the system refused."""
    try:
        write(path)
    except OSError as error:
        raise SysidError(of_system(error)) from None
    return path


class Picture:
    """figure: matplotlib's, to be changed at will."""

    def __init__(self, figure: Figure) -> None:
        self.figure = figure

    def save(self, path: str | Path) -> Path:
        """Write it; the file's ending (.png, .svg, .pdf) says as what. Raises SysidError."""
        path, kinds = path_of(path), self.figure.canvas.get_supported_filetypes()
        if path.suffix.lower().removeprefix(".") not in kinds:
            raise SysidError(
                f"'{path}' does not say which kind of picture; expected a name that ends in .png, .svg or .pdf: choose "
                "one"
            )
        return written(path, lambda path: self.figure.savefig(path, dpi=2 * _DOTS_PER_INCH))

    def __str__(self) -> str:
        panels = len([axes for axes in self.figure.axes if axes.get_visible()])
        return f"A picture of {count_text(panels, 'panel')}: a notebook shows it, and save('picture.png') writes it."

    __repr__ = __str__

    def _repr_png_(self) -> bytes:
        buffer = BytesIO()
        self.figure.savefig(buffer, format="png", dpi=_DOTS_PER_INCH)
        return buffer.getvalue()


def draw_recordings(experiments: Sequence[Experiment]) -> Picture:
    """Measured sin θ of every recording."""
    figure, axes = _grid(len(experiments))
    for axis, each in zip(axes, experiments, strict=True):
        axis.plot(each.run.time, each.sin_theta, ".", color=MEASURED, markersize=2.5)
        axis.set_title(each.name, fontsize=9)
    return Picture(figure)


def draw_comparisons(comparisons: Sequence[Comparison]) -> Picture:
    """Measured against simulated, every run's offset taken out of the measurement."""
    runs = comparisons[0].runs
    figure, axes = _grid(len(runs))
    for number, (axis, run) in enumerate(zip(axes, runs, strict=True)):
        series = run.series
        axis.plot(series.time, series.measured - series.offset, ".", color=MEASURED, markersize=3, alpha=0.5)
        for which, comparison in enumerate(comparisons):
            shown = comparison.runs[number].series
            simulated = shown.simulated + shown.offset - series.offset
            axis.plot(
                shown.time,
                simulated,
                color=MODELS[which % len(MODELS)],
                linewidth=1.1,
                label=comparison.label,
            )
        axis.set_title(run.name + (" (unseen)" if run.unseen else ""), fontsize=9)
    figure.legend(
        *axes[0].get_legend_handles_labels(), frameon=False, ncols=3, loc="outside lower center", fontsize=8
    )
    return Picture(figure)


def draw_ranking(diagnosis: Diagnosis) -> Picture:
    """Share of the error above the noise that the best effects remove, the most probable on top."""
    shown = diagnosis.findings[:_MOST_EFFECTS]
    figure = Figure(figsize=(6.4, 0.6 + 0.34 * len(shown)), layout="constrained")
    axis = figure.add_subplot()
    place = np.arange(len(shown))
    axis.barh(
        place - 0.2, [100 * each.probability for each in shown], 0.38, color=FITTED, label="probability [%]"
    )
    removed = [100 * each.error_removed for each in shown]
    axis.barh(place + 0.2, removed, 0.38, color=DROP, label="error removed [%]")
    axis.set_yticks(place, [f"{each.effect}: {each.verdict.value}" for each in shown])
    axis.invert_yaxis()
    axis.set_xlim(0, 100)
    axis.legend(frameon=False, fontsize=8)
    bare(axis)
    return Picture(figure)


def draw_stages(stages: Sequence[Stage], noise_floor: float) -> Picture:
    """Mean |Δ sin θ| of every stage on fitted and on unseen runs, and the noise."""
    figure = Figure(figsize=(1.8 + 1.6 * len(stages), 3.0), layout="constrained")
    axis = figure.add_subplot()
    place = np.arange(len(stages))
    axis.bar(place - 0.2, [stage.mae_fit for stage in stages], 0.38, color=FITTED, label="fitted runs")
    unseen = [stage.mae_validation for stage in stages if stage.mae_validation is not None]
    if len(unseen) == len(stages):
        axis.bar(place + 0.2, unseen, 0.38, color=UNSEEN, label="unseen runs")
    axis.axhline(noise_floor, color=NOISE, linestyle="--", linewidth=1.0, label="noise floor")
    axis.set_xticks(place, ["fitted", *("+ " + stage.added[-1] for stage in stages[1:])])
    axis.set_ylabel("mean |Δ sin θ|")
    axis.legend(frameon=False, fontsize=8)
    bare(axis)
    return Picture(figure)


def _grid(count: int) -> tuple[Figure, list[Axes]]:
    columns = min(_COLUMNS, count)
    rows = -(-count // columns)
    figure = Figure(figsize=(3.4 * columns, 0.3 + 2.2 * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False, sharey=True).ravel().tolist()
    for axis in axes[count:]:
        axis.set_visible(False)
    for axis in axes[:count]:
        bare(axis)
        axis.set_xlabel("time [s]", fontsize=8)
    for axis in axes[:count:columns]:
        axis.set_ylabel("sin θ")
    return figure, axes[:count]
