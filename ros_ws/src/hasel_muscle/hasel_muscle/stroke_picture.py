"""The bench's picture: answer by voltage, measured and at every stage; what is left; the error falling."""

from pathlib import Path

import numpy as np
from hasel_sim.muscle.muscle import Muscle
from matplotlib.figure import Figure

from hasel_muscle.problem import BenchProblem
from hasel_muscle.result import BenchImprovement
from hasel_muscle.shown import stage_name

_LEAST_FORCE = 1e-2
"""Of the drawing [N]."""
_GREY, _INK = "#9aa0a6", "#202124"
_COLOURS = ("#9aa0a6", "#f29900", "#1a73e8", "#188038", "#a142f4", "#d93025")


def write_picture(
    found: BenchImprovement, fitted: BenchProblem, unseen: BenchProblem | None, path: Path
) -> None:
    """Write a PNG."""
    figure = Figure(figsize=(11, 7.2), layout="constrained")
    curve, falling, left, law = figure.subplots(2, 2).ravel()
    unit = fitted.runs[0].unit
    factor, shown = (1e3, "contraction [mm]") if unit == "m" else (1.0, "force [N]")
    parts = [(fitted, "o", "measured"), *([(unseen, "s", "measured, unseen")] if unseen else [])]
    for problem, marker, label in parts:
        volts, measured = _lifts(problem, unit, problem.measured)
        face = _INK if marker == "o" else "white"
        curve.plot(volts / 1e3, factor * measured, marker, color=_INK, mfc=face, ms=5, label=label, zorder=5)
    for number, stage in enumerate(found.stages):
        name, colour = stage_name(stage, number), _COLOURS[number % len(_COLOURS)]
        both = [_lifts(problem, unit, problem.predicted(stage.muscle)) for problem, _, _ in parts]
        volts, predicted = (np.concatenate(each) for each in zip(*both, strict=True))
        order = np.argsort(volts, kind="stable")
        curve.plot(volts[order] / 1e3, factor * predicted[order], color=colour, label=name)
        if number:
            for problem, marker, _ in parts:
                at, away = _lifts(problem, unit, problem.predicted(stage.muscle) - problem.measured)
                face = colour if marker == "o" else "white"
                left.plot(at / 1e3, factor * away, marker, color=colour, mfc=face, ms=4)
    curve.set(xlabel="voltage [kV]", ylabel=shown, title="lifts (mean of the settled frames)")
    curve.legend(fontsize=8, frameon=False)
    left.axhline(0, color=_GREY, lw=0.8)
    left.set(
        xlabel="voltage [kV]", ylabel=f"law - measurement, {shown}", title="what is left (hollow: unseen)"
    )
    _falling(falling, found, unit, factor)
    _force_strain(law, found.muscle, float(max(np.abs(run.voltage).max() for run in fitted.runs)))
    for axes in (curve, falling, left, law):
        axes.spines[["top", "right"]].set_visible(False)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)


def _lifts(problem: BenchProblem, unit: str, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Voltage [V] and mean of a series over the frames of every driven hold of one quantity."""
    mine = np.concatenate([np.full(run.used.sum(), run.unit == unit) for run in problem.runs])
    here = problem.driven & mine.astype(bool)
    holds = np.unique(problem.holds[here])
    chosen = [here & (problem.holds == hold) for hold in holds]
    volts = np.array([problem.levels[frames][0] for frames in chosen])
    return volts, np.array([values[frames].mean() for frames in chosen])


def _falling(axes, found: BenchImprovement, unit: str, factor: float) -> None:
    names = [stage_name(stage, number) for number, stage in enumerate(found.stages)]
    place = np.arange(len(names))
    axes.barh(
        place - 0.2,
        [factor * s.error.get(unit, np.nan) for s in found.stages],
        0.36,
        color="#1a73e8",
        label="fitted",
    )
    axes.barh(
        place + 0.2,
        [factor * s.unseen.get(unit, np.nan) for s in found.stages],
        0.36,
        color="#f29900",
        label="unseen",
    )
    axes.set_yticks(place, names)
    axes.invert_yaxis()
    axes.set(
        xscale="log",
        xlabel=f"mean |law - measurement| [{'mm' if unit == 'm' else 'N'}]",
        title="the error falling",
    )
    axes.legend(fontsize=8, frameon=False)


def _force_strain(axes, muscle: Muscle, highest: float) -> None:
    top = muscle.contraction(np.zeros(1), np.array([highest]), np.zeros(1), 0.0)[0] / muscle.rest_length
    strain = np.linspace(0.0, top, 81)
    for share, colour in ((1.0, "#1a73e8"), (0.75, "#7baaf7"), (0.5, "#aecbfa")):
        force = muscle.force(np.arange(81.0) * 1e6, np.full(81, share * highest), strain * muscle.rest_length)
        force = np.where(force > _LEAST_FORCE, force, np.nan)
        axes.plot(100 * strain, force, color=colour, label=f"{share * highest / 1e3:.3g} kV")
    axes.set(xlabel="strain [%]", ylabel="force [N]", title="force against strain, as fitted", yscale="log")
    axes.legend(fontsize=8, frameon=False)
