# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Comparisons, as tables, and faults of the set-up on the terminal."""

import sys
from collections.abc import Callable, Collection, Sequence

from rich.console import Console
from rich.table import Table

from hasel_sysid.command_line.running import MISLEADING
from hasel_sysid.comparison import Comparison, ConditionError
from hasel_sysid.data_quality import DataFinding, Severity, check_recording
from hasel_sysid.experiment import Experiment

_CAPTION = (
    "with offset: the same with it left in; fit %: 100 is a perfect model, 0 no better than the run's mean"
)


def run_table(comparisons: Sequence[Comparison]) -> Table:
    """One row per run; error, offset and fit of one model, or the errors of several side by side."""
    table = Table(title="mean |Δ sin θ|, each run's offset taken out", title_justify="left")
    for name in ("run", "drive", "Hz"):
        table.add_column(name, justify="left" if name == "run" else "right")
    single = len(comparisons) == 1
    if single:
        table.caption, table.caption_justify = _CAPTION, "left"
    names = ["error", "with offset", "fit %"] if single else [c.label for c in comparisons]
    for name in names:
        table.add_column(name, justify="right")
    for index, run in enumerate(comparisons[0].runs):
        if single:
            cells = [
                f"{run.mean_absolute_error:.5f}",
                f"{run.mean_absolute_error_raw:.5f}",
                f"{run.fit_percent:.1f}",
            ]
        else:
            cells = [f"{c.runs[index].mean_absolute_error:.5f}" for c in comparisons]
        label = f"{run.name} (unseen)" if run.unseen else run.name
        frequency = f"{run.series.frequency:.2g}" if run.series.frequency else "-"
        table.add_row(label, run.series.level_text, frequency, *cells)
    table.add_section()
    totals = (
        ("all fitted runs", [c.mean_absolute_error for c in comparisons]),
        ("all unseen runs", [c.mean_absolute_error_unseen for c in comparisons]),
    )
    for label, errors in totals:
        if errors[0] is not None:
            table.add_row(label, "", "", *(f"{error:.5f}" for error in errors))
    return table


def speed_table(comparisons: Sequence[Comparison]) -> Table | None:
    """Swimming speeds of every run, measured and of each model; None where nothing swims."""
    if all(comparison.mean_speed_error is None for comparison in comparisons):
        return None
    table = Table(title="swimming speed of the head marker, mm/s", title_justify="left")
    table.add_column("run")
    table.add_column("measured", justify="right")
    for comparison in comparisons:
        table.add_column("simulated" if len(comparisons) == 1 else comparison.label, justify="right")
    for index, run in enumerate(comparisons[0].runs):
        if run.speed is not None:
            found = [comparison.runs[index].speed for comparison in comparisons]
            cells = ["-" if speed is None else f"{1e3 * speed.simulated:.2f}" for speed in found]
            label = f"{run.name} (unseen)" if run.unseen else run.name
            table.add_row(label, f"{1e3 * run.speed.measured:.2f}", *cells)
    table.add_section()
    errors = [comparison.mean_speed_error for comparison in comparisons]
    table.add_row("mean |Δ speed|", "", *("-" if e is None else f"{1e3 * e:.2f}" for e in errors))
    return table


def condition_table(comparisons: Sequence[Comparison]) -> Table:
    """Errors by level of the drive and by frequency, one column per model."""
    table = Table(title="by drive and frequency", title_justify="left")
    table.add_column("condition", justify="right")
    table.add_column("runs", justify="right")
    for comparison in comparisons:
        table.add_column("error" if len(comparisons) == 1 else comparison.label, justify="right")
    _add_conditions(table, [c.by_level for c in comparisons])
    table.add_section()
    _add_conditions(table, [c.by_frequency for c in comparisons])
    return table


def _add_conditions(table: Table, columns: Sequence[Sequence[ConditionError]]) -> None:
    for rows in zip(*columns, strict=True):
        errors = [f"{row.mean_absolute_error:.5f}" for row in rows]
        table.add_row(rows[0].label, str(rows[0].runs), *errors)


def announce(experiments: Sequence[Experiment], but: Collection[str] = ()) -> list[DataFinding]:
    """Check recordings before anything is simulated; faults of the set-up but these go to stderr, and are returned."""
    found = [
        f for experiment in experiments for f in check_recording(experiment.recording) if f.fault not in but
    ]
    tell(found)
    return found


def show(comparisons: Sequence[Comparison], said: Sequence[DataFinding] = ()) -> None:
    """Print tables and where the models fail, and those faults of the set-up that have not been `said`."""
    tell(comparisons[0].set_up, said)
    console = Console(soft_wrap=True)
    console.print(run_table(comparisons))
    speeds = speed_table(comparisons)
    if speeds is not None:
        console.print(speeds)
    if any(run.series.level > 0 for run in comparisons[0].runs):
        console.print(condition_table(comparisons))
    for comparison in comparisons:
        print(comparison)
        for sentence in comparison.where.sentences():
            print(f"  {sentence}")


def summarise(lines: Sequence[str], everything: Callable[[], None], show_all: bool, others: str) -> None:
    """Print what a person needs and, where asked to, everything before it."""
    if show_all:
        everything()
    print("\n".join(lines))
    if not show_all:
        print(f"({others}: --all, and in the report)")


def code_after(findings: Sequence[DataFinding]) -> int:
    """Exit code of a command that ran to its end: MISLEADING where a recording has a fault that misleads."""
    return MISLEADING if any(finding.severity is Severity.ERROR for finding in findings) else 0


def tell(findings: Sequence[DataFinding], said: Sequence[DataFinding] = ()) -> None:
    """Print the faults of the set-up that have not been `said`."""
    for finding in findings:
        if finding in said:
            continue
        print(f"{finding.severity.value}: {finding}", file=sys.stderr)
