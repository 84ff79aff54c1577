# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`measured_fish DIR`: speeds of a filmed fish against those that the forces of the fluid give it."""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from hasel_recording.csv_run import write_csv
from hasel_sim.mesh_picture import save_picture
from hasel_sim.swimming.given_shape import fitted_form_drag, settled_speed
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table

from hasel_sysid.command_line.options import measured_fish_parser
from hasel_sysid.command_line.running import told, write_json
from hasel_sysid.data_quality.finding import DataFinding
from hasel_sysid.data_quality.response import check_drive_frequency
from hasel_sysid.errors import SysidError
from hasel_sysid.filmed_fish import FilmedRun, SeenBeat, filmed_runs, fish_of, seen_beat

PUBLISHED = {"ellipsoids with five fitted coefficients": 0.019, "elongated-body theory with two": 0.134}
"""Mean speed errors [m/s] in the fish's publication, arXiv 2602.23283."""
PICTURE_FILE = "measured_fish.png"


@dataclass(frozen=True)
class ComparedFilm:
    """found: by the data check, in the drive's frequency; simulated: speed [m/s]; fitted: the drag was fitted to it."""

    name: str
    seen: SeenBeat
    found: tuple[DataFinding, ...]
    simulated: float
    fitted: bool

    @property
    def error(self) -> float:
        """Simulated minus measured speed [m/s]."""
        return self.simulated - self.seen.beat.speed

    def to_json(self) -> dict[str, Any]:
        """Plain numbers and words."""
        beat = self.seen.beat
        return {
            "name": self.name,
            "named_frequency_hz": self.seen.named_frequency,
            "tail_frequency_hz": beat.frequency,
            "amplitude_m": beat.amplitude,
            "speed_m_per_s": beat.speed,
            "simulated_speed_m_per_s": self.simulated,
            "fitted": self.fitted,
            "findings": [each.to_json() for each in self.found],
        }


@dataclass(frozen=True)
class FishComparison:
    """films: in the order of their frequency; form_drag: of the blunt head [1], the one number that is fitted."""

    films: tuple[ComparedFilm, ...]
    form_drag: float

    @property
    def mean_error(self) -> float:
        """Mean |error| of the speed [m/s], of all films."""
        return float(np.mean([abs(film.error) for film in self.films]))

    @property
    def mean_unseen_error(self) -> float:
        """The same of those that the drag was not fitted to; NaN without any."""
        errors = [abs(film.error) for film in self.films if not film.fitted]
        return float(np.mean(errors)) if errors else float("nan")

    def __str__(self) -> str:
        unseen = sum(not film.fitted for film in self.films)
        published = ", ".join(f"{error:g} m/s for {name}" for name, error in PUBLISHED.items())
        return (
            f"With a form drag of the head of {self.form_drag:.2f}, fitted to {len(self.films) - unseen} of "
            f"{len(self.films)} films: mean |Δ speed| {self.mean_error:.3f} m/s, {self.mean_unseen_error:.3f} m/s on "
            f"the {unseen} others. Published: {published}."
        )

    def to_json(self) -> dict[str, Any]:
        """Plain numbers and words."""
        return {
            "form_drag": self.form_drag,
            "mean_error_m_per_s": self.mean_error,
            "mean_unseen_error_m_per_s": self.mean_unseen_error,
            "films": [film.to_json() for film in self.films],
        }


def compare_films(runs: Sequence[FilmedRun], fitted: Sequence[float]) -> FishComparison:
    """Speeds by the fluid's forces for the beats that were seen, the head's drag fitted to some of them.

    fitted: named frequencies [Hz]. Raises SysidError for one that no run has, SimulationError where no drag fits.
    """
    known = [run.named_frequency for run in runs]
    for frequency in fitted:
        if frequency not in known:
            raise SysidError(
                f"no film is named {frequency:g} Hz; expected some of {', '.join(f'{f:g}' for f in known)}: correct "
                "--fitted"
            )
    beats = [seen_beat(run) for run in runs]
    fish = fish_of(beats)
    chosen = [beat.beat for beat in beats if beat.named_frequency in fitted]
    drag = fitted_form_drag(fish, chosen)
    films = [
        ComparedFilm(
            run.recording.name,
            beat,
            tuple(check_drive_frequency(run.recording)),
            settled_speed(fish, beat.beat, drag),
            run.named_frequency in fitted,
        )
        for run, beat in zip(runs, beats, strict=True)
    ]
    return FishComparison(tuple(films), drag)


def write_picture(found: FishComparison, path: Path) -> None:
    """Write a PNG."""
    figure = Figure(figsize=(7, 4.5), layout="constrained")
    axes = figure.subplots()
    tail = [film.seen.beat.frequency for film in found.films]
    axes.plot(tail, [film.simulated for film in found.films], "s--", color="#1a73e8", label="simulated")
    for fitted, face, label in (
        (True, "#202124", "measured, drag fitted"),
        (False, "white", "measured, unseen"),
    ):
        beats = [film.seen.beat for film in found.films if film.fitted == fitted]
        axes.plot(
            [b.frequency for b in beats],
            [b.speed for b in beats],
            "o",
            color="#202124",
            mfc=face,
            label=label,
        )
    axes.set(xlabel="frequency of the tail [Hz]", ylabel="speed [m/s]", xlim=(0, None), ylim=(0, None))
    axes.set_title("A filmed robot fish and the forces of the fluid")
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    save_picture(figure, path)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns its exit code."""
    return run(measured_fish_parser().parse_args(arguments))


@told
def run(options: argparse.Namespace) -> None:
    """Run the command with these options; returns its exit code."""
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
