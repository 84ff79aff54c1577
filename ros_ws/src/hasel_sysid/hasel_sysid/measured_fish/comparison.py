"""Speeds of a filmed fish against those that the forces of the fluid give it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.swimming.given_shape import fitted_form_drag, settled_speed

from hasel_sysid.data_gate.drive_frequency import check_drive_frequency
from hasel_sysid.data_gate.finding import DataFinding
from hasel_sysid.errors import SysidError
from hasel_sysid.measured_fish.beating import SeenBeat, fish_of, seen_beat
from hasel_sysid.measured_fish.films import FilmedRun

PUBLISHED = {"ellipsoids with five fitted coefficients": 0.019, "elongated-body theory with two": 0.134}
"""Mean speed errors [m/s] in the fish's publication, arXiv 2602.23283."""


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

    def to_json(self) -> dict:
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

    def to_json(self) -> dict:
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
