"""Comparisons on the terminal."""

import sys
from collections.abc import Sequence

from rich.console import Console

from hasel_sysid.compare import Comparison
from hasel_sysid.compare.table import condition_table, run_table


def show(comparisons: Sequence[Comparison]) -> None:
    """Print tables, faults of the set-up and where the models fail."""
    console = Console(soft_wrap=True)
    for finding in comparisons[0].set_up:
        print(f"{finding.severity.value}: {finding}", file=sys.stderr)
    console.print(run_table(comparisons))
    if any(run.series.voltage > 0 for run in comparisons[0].runs):
        console.print(condition_table(comparisons))
    for comparison in comparisons:
        print(comparison)
        for sentence in comparison.where.sentences():
            print(f"  {sentence}")
