# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the bench shows: tables and sentences for the terminal, JSON, a picture, and one HTML page with it."""

import base64
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
from hasel_sim.muscle.effect import muscle_catalogue
from hasel_sim.muscle.muscle import Muscle
from hasel_sysid.estimation.fit import FittedModel
from hasel_sysid.report.content import provenance
from jinja2 import Environment, FunctionLoader, StrictUndefined
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from rich.table import Table

from hasel_muscle.bench_improvement import BenchImprovement, MuscleStage
from hasel_muscle.bench_problem import BenchProblem
from hasel_muscle.law_check import Rival
from hasel_muscle.swinging import WINDOW_S, Swinging

_DECIMALS = 6
"""Of millimetres and newtons; what lies below is rounding."""
_UNITS = {"m": (1e3, "mm"), "N": (1.0, "N")}


@dataclass(frozen=True)
class BenchResult:
    """found: of `fitted`, compared with `unseen` where there is such; fails: where the fitted law fails, in sentences;
    rival: law and table on unseen lifts; swings: how the load swings, where it does.
    """

    found: BenchImprovement
    fitted: BenchProblem
    unseen: BenchProblem | None
    fails: tuple[str, ...]
    rival: Rival | None
    swings: Swinging | None


def quantity(value: float, unit: str) -> str:
    """A size in the unit in which it is read."""
    factor, shown = _UNITS[unit]
    return f"{round(factor * value, _DECIMALS) + 0.0:.3g} {shown}"


def stroke_table(
    problem: BenchProblem, muscles: Sequence[tuple[str, Muscle]], unseen: BenchProblem | None
) -> Table:
    """Measured and simulated answer by voltage and load; unseen voltages are marked."""
    table = Table(title="settled lifts, mean of all at one voltage and load; *: unseen", title_justify="left")
    for name in ("voltage", "held", "lifts", "measured", *(name for name, _ in muscles)):
        table.add_column(name, justify="right", no_wrap=True)
    laws = [muscle for _, muscle in muscles]
    rows = [*_rows(problem, laws, ""), *(_rows(unseen, laws, " *") if unseen else ())]
    for volts, cells, mark in sorted(rows):
        table.add_row(f"{volts:g} V{mark}", *cells)
    return table


def _rows(
    problem: BenchProblem, laws: Sequence[Muscle], mark: str
) -> Iterator[tuple[float, tuple[str, ...], str]]:
    """Voltage [V], the other cells, and the mark."""
    for run in problem.runs:
        answers = [run.measured, *(run.predicted(law) for law in laws)]
        kept_unit = "N" if run.held == "load" else "m"
        at = np.array([float(f"{value:.2g}") for value in run.kept])
        voltage, level, hold = (each[run.used] for each in (run.voltage, run.level, run.hold))
        for volts, held in sorted(set(zip(level[voltage != 0], at[voltage != 0], strict=True))):
            here = (voltage != 0) & (level == volts) & (at == held)
            shown = [quantity(float(np.mean(answer[here])), run.unit) for answer in answers]
            lifts = str(len(np.unique(hold[here])))
            yield float(volts), (quantity(float(held), kept_unit), lifts, *shown), mark


def stage_name(stage: MuscleStage, number: int) -> str:
    """What a stage is called."""
    return ("the formula, nothing fitted", "fitted")[number] if number < 2 else "+ " + " + ".join(stage.added)


def stage_table(found: BenchImprovement) -> Table:
    """The error at each stage, on fitted and on unseen lifts."""
    table = Table(title="mean |law - measurement| of settled frames", title_justify="left")
    for name in ("model", "fitted voltages", "unseen"):
        table.add_column(name, justify="left" if name == "model" else "right")
    for number, stage in enumerate(found.stages):
        cells = [", ".join(quantity(e, u) for u, e in each.items()) for each in (stage.error, stage.unseen)]
        table.add_row(stage_name(stage, number), *cells)
    return table


def sentences(found: BenchImprovement) -> list[str]:
    """What the terminal says below the tables."""
    said = []
    for before, stage in zip(found.stages[1:], found.stages[2:], strict=False):
        fell = [f"{quantity(before.error[u], u)} to {quantity(e, u)}" for u, e in stage.error.items()]
        said.append(f"{' and '.join(stage.added)} is missing: it takes the error from {', '.join(fell)}.")
        if stage.rivals:
            said.append(f"  These lifts cannot tell it from {', '.join(stage.rivals)}.")
    if not found.missing:
        said.append("No effect predicts voltages left out better by more than one standard error.")
    said.append(str(found.described))
    last = found.stages[-1].fit
    beyond = "would leave its plausible range: a constant is wrong, or something else is missing."
    return [*said, fitted(last), *(f"  {name} {beyond}" for name in last.at_bound)]


def fitted(fit: FittedModel) -> str:
    """What a fit came to."""
    values = [str(fit.model.parameters[name]) for name in fit.model.free]
    bounds = "".join(f"; {name} is at its bound" for name in fit.at_bound)
    return f"Fitted: {'; '.join(values) or 'nothing is free'}{bounds}."


def lift_table(swings: Swinging) -> Table:
    """How high the load swings after every lift, measured and by the law with its inertia."""
    title = f"swinging in the first {WINDOW_S:g} s of a lift (*: unseen), mm"
    table = Table(title=title, title_justify="left")
    for name in ("lift", "highest", "simulated", "mean error", "without inertia"):
        table.add_column(name, justify="right")
    for lift in swings.lifts:
        numbers = (*lift.peak, *lift.errors)
        label = f"{lift.level:g} V{' *' if lift.unseen else ''}"
        table.add_row(label, *(f"{1e3 * number:.2f}" for number in numbers))
    return table


def to_json(result: BenchResult) -> dict[str, Any]:
    """The same for other programs."""
    found, rival, swings = result.found, result.rival, result.swings
    return {
        "noise_floor": found.described.noise,
        "error": found.described.error,
        "allowed": found.described.allowed,
        "repeatability": found.described.repeats,
        "stages": [
            {
                "name": stage_name(stage, number),
                "effects": [effect.id for effect in stage.muscle.effects],
                "parameters": {
                    p.name: {"value": p.value, "std": p.standard_error, "unit": p.unit}
                    for p in stage.muscle.parameters.values()
                },
                "mae_fit": stage.error,
                "mae_validation": stage.unseen,
            }
            for number, stage in enumerate(found.stages)
        ],
        "effects": [
            {"effect": each.effect, "verdict": each.verdict.name.lower(), "reason": each.reason}
            for each in found.findings
        ],
        "indistinguishable": [list(group) for group in found.groups],
        "unseen_lifts": None if rival is None else {"law_m": rival.law, "table_m": rival.table},
        "swinging": None if swings is None else swings.to_json(),
        "verdict": {"status": found.status.value, "missing": found.missing},
    }


_LEAST_FORCE = 1e-2
"""Of the drawing [N]."""
_GREY, _INK = "#9aa0a6", "#202124"
_COLOURS = ("#9aa0a6", "#f29900", "#1a73e8", "#188038", "#a142f4", "#d93025")


def write_picture(result: BenchResult, path: Path) -> None:
    """Write a PNG."""
    found, fitted, unseen = result.found, result.fitted, result.unseen
    figure = Figure(figsize=(11, 7.2), layout="constrained")
    curve, falling, left, law = figure.subplots(2, 2).ravel()
    unit = fitted.runs[0].unit
    factor, shown = _UNITS[unit][0], "contraction [mm]" if unit == "m" else "force [N]"
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
    label = f"law - measurement, {shown}"
    left.set(xlabel="voltage [kV]", ylabel=label, title="what is left (hollow: unseen)")
    _falling(falling, found, unit, factor)
    _force_strain(law, found.muscle, float(max(np.abs(run.voltage).max() for run in fitted.runs)))
    for axes in (curve, falling, left, law):
        axes.spines[["top", "right"]].set_visible(False)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)


def _lifts(problem: BenchProblem, unit: str, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Voltage [V] and mean of a series over the frames of every driven hold of one quantity."""
    here = problem.driven & (problem.units == unit)
    _, first, hold = np.unique(problem.holds[here], return_index=True, return_inverse=True)
    return problem.levels[here][first], np.bincount(hold, values[here]) / np.bincount(hold)


def _falling(axes: Axes, found: BenchImprovement, unit: str, factor: float) -> None:
    names = [stage_name(stage, number) for number, stage in enumerate(found.stages)]
    place = np.arange(len(names))
    for side, label, colour in ((-0.2, "fitted", "#1a73e8"), (0.2, "unseen", "#f29900")):
        errors = [stage.error if label == "fitted" else stage.unseen for stage in found.stages]
        sizes = [factor * error.get(unit, np.nan) for error in errors]
        axes.barh(place + side, sizes, 0.36, color=colour, label=label)
    axes.set_yticks(place, names)
    axes.invert_yaxis()
    label = f"mean |law - measurement| [{_UNITS[unit][1]}]"
    axes.set(xscale="log", xlabel=label, title="the error falling")
    axes.legend(fontsize=8, frameon=False)


def _force_strain(axes: Axes, muscle: Muscle, highest: float) -> None:
    top = muscle.contraction(np.zeros(1), np.array([highest]), np.zeros(1), 0.0)[0] / muscle.rest_length
    strain = np.linspace(0.0, top, 81)
    for share, colour in ((1.0, "#1a73e8"), (0.75, "#7baaf7"), (0.5, "#aecbfa")):
        force = muscle.force(np.arange(81.0) * 1e6, np.full(81, share * highest), strain * muscle.rest_length)
        force = np.where(force > _LEAST_FORCE, force, np.nan)
        axes.plot(100 * strain, force, color=colour, label=f"{share * highest / 1e3:.3g} kV")
    axes.set(xlabel="strain [%]", ylabel="force [N]", title="force against strain, as fitted", yscale="log")
    axes.legend(fontsize=8, frameon=False)


def write_report(result: BenchResult, picture: Path, path: Path) -> None:
    """Write the page; picture: a PNG that is taken into it."""
    found = result.found
    templates = FunctionLoader(_template)
    environment = Environment(loader=templates, autoescape=True, undefined=StrictUndefined, trim_blocks=True)
    page = environment.get_template("bench_muscle.html").render(
        muscle=found.muscle.name,
        status=found.status.value.replace("_", " "),
        sentences=sentences(found),
        fails=result.fails,
        stages=[(stage_name(stage, number), stage) for number, stage in enumerate(found.stages)],
        findings=found.findings,
        catalogue=muscle_catalogue(),
        parameters=found.muscle.parameters.values(),
        rival=result.rival,
        swings=result.swings,
        quantity=quantity,
        picture=base64.b64encode(picture.read_bytes()).decode(),
        style=_template("style.css"),
        made=provenance(),
    )
    path.write_text(page, encoding="utf-8")


def _template(name: str) -> str:
    return (resources.files("hasel_sysid") / "report" / "templates" / name).read_text(encoding="utf-8")
