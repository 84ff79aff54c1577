"""`measured_fish DIR`: the public filmed fish, whose speeds follow from how its tail beats."""

import argparse
import sys
from collections.abc import Sequence

from hasel_recording.csv_run import write_csv
from rich.console import Console
from rich.table import Table

from hasel_sysid.command_line.json_file import write_json
from hasel_sysid.command_line.running import run_command
from hasel_sysid.command_line.specimen_parsers import measured_fish_parser
from hasel_sysid.measured_fish.comparison import FishComparison, compare_films
from hasel_sysid.measured_fish.films import filmed_runs
from hasel_sysid.measured_fish.fish_picture import write_picture

PICTURE_FILE = "measured_fish.png"


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(measured_fish_parser().parse_args(arguments))


def run(options: argparse.Namespace) -> int:
    """Run the command with these options."""
    return run_command(lambda: _compare(options))


def _compare(options: argparse.Namespace) -> None:
    runs = filmed_runs(options.folder)
    found = compare_films(runs, options.fitted)
    options.output.mkdir(parents=True, exist_ok=True)
    for each in runs:
        write_csv(each.recording, options.output / f"{each.recording.name}.csv")
    write_picture(found, options.output / PICTURE_FILE)
    console = Console(highlight=False)
    console.print(_table(found))
    for film in found.films:
        for finding in film.found:
            console.print(f"{film.name}: {finding.sentence}", markup=False, soft_wrap=True)
    console.print(str(found), markup=False, soft_wrap=True)
    console.print(
        f"Wrote {options.output / PICTURE_FILE}, and each film as a recording.", markup=False, soft_wrap=True
    )
    if options.json:
        write_json(found.to_json(), options.json)


def _table(found: FishComparison) -> Table:
    table = Table(title="Speed of a filmed fish, m/s")
    for name in ("film", "named Hz", "tail Hz", "ratio", "measured", "simulated", "error"):
        table.add_column(name, justify="left" if name == "film" else "right")
    for film in found.films:
        beat = film.seen.beat
        table.add_row(
            film.name + (" (fitted)" if film.fitted else ""),
            f"{film.seen.named_frequency:g}",
            f"{beat.frequency:.3f}",
            f"{film.seen.ratio:.3f}",
            f"{beat.speed:.4f}",
            f"{film.simulated:.4f}",
            f"{film.error:+.4f}",
        )
    return table


if __name__ == "__main__":
    sys.exit(main())
