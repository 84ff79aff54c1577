"""Comparisons as tables for the terminal."""

from collections.abc import Sequence

from rich.table import Table

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.where_it_fails.by_condition import ConditionError

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
    _add(table, [c.by_level for c in comparisons])
    table.add_section()
    _add(table, [c.by_frequency for c in comparisons])
    return table


def _add(table: Table, columns: Sequence[Sequence[ConditionError]]) -> None:
    for rows in zip(*columns, strict=True):
        errors = [f"{row.mean_absolute_error:.5f}" for row in rows]
        table.add_row(rows[0].label, str(rows[0].runs), *errors)
