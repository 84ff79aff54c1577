"""Comparisons and faults of the set-up on the terminal."""

import sys
from collections.abc import Callable, Collection, Sequence

from rich.console import Console

from hasel_sysid.command_line.running import MISLEADING
from hasel_sysid.compare import Comparison
from hasel_sysid.compare.table import condition_table, run_table, speed_table
from hasel_sysid.data_gate import DataFinding, Severity, check_recording
from hasel_sysid.experiment import Experiment


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
