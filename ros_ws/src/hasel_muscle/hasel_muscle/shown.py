"""Results of the bench as tables and sentences for the terminal, and for other programs."""

from collections.abc import Sequence

import numpy as np
from hasel_sim.muscle.muscle import Muscle
from hasel_sysid.estimation.fit import FittedModel
from rich.table import Table

from hasel_muscle.lifts import WINDOW_S
from hasel_muscle.problem import BenchProblem
from hasel_muscle.result import BenchImprovement, MuscleStage
from hasel_muscle.stroke_table import Rival
from hasel_muscle.swinging import Swinging

_DECIMALS = 6
"""Of millimetres and newtons; what lies below is rounding."""
_UNITS = {"m": (1e3, "mm"), "N": (1.0, "N")}


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
    fitted = [(row, "") for row in _rows(problem, [muscle for _, muscle in muscles])]
    apart = [(row, " *") for row in _rows(unseen, [muscle for _, muscle in muscles])] if unseen else []
    for row, mark in sorted([*fitted, *apart]):
        table.add_row(f"{row[0]:g} V{mark}", *row[1:])
    return table


def _rows(problem: BenchProblem, muscles: Sequence[Muscle]) -> list[tuple]:
    rows = []
    for run in problem.runs:
        predicted = [run.predicted(muscle) for muscle in muscles]
        kept, kept_unit = (run.load, "N") if run.held == "load" else (run.contraction, "m")
        at = np.array([float(f"{value:.2g}") for value in kept[run.used]])
        voltage, level, hold = (each[run.used] for each in (run.voltage, run.level, run.hold))
        for volts, held in sorted(set(zip(level[voltage != 0], at[voltage != 0], strict=True))):
            here = (voltage != 0) & (level == volts) & (at == held)
            lifts = len(np.unique(hold[here]))
            answers = [run.measured, *predicted]
            shown = [quantity(float(np.mean(answer[here])), run.unit) for answer in answers]
            rows.append((float(volts), quantity(float(held), kept_unit), str(lifts), *shown))
    return rows


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
    for stage in found.stages[2:]:
        before = found.stages[found.stages.index(stage) - 1]
        fell = ", ".join(
            f"{quantity(before.error[u], u)} to {quantity(e, u)}" for u, e in stage.error.items()
        )
        said.append(f"{' and '.join(stage.added)} is missing: it takes the error from {fell}.")
        if stage.rivals:
            said.append(f"  These lifts cannot tell it from {', '.join(stage.rivals)}.")
    if not found.missing:
        said.append("No effect predicts voltages left out better by more than one standard error.")
    said.append(str(found.described))
    last = found.stages[-1].fit
    said.append(fitted(last))
    for name in last.at_bound:
        said.append(
            f"  {name} would leave its plausible range: a constant is wrong, or something else is missing."
        )
    return said


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


def to_json(found: BenchImprovement, rival: Rival | None, swings: Swinging | None = None) -> dict:
    """The same for other programs."""
    return {
        "noise_floor": found.described.noise,
        "error": found.described.error,
        "allowed": found.described.allowed,
        "repeatability": found.described.repeats,
        "stages": [
            {
                "name": stage_name(stage, number),
                "effects": stage.effects,
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
