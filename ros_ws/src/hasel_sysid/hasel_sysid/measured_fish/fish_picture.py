"""Speed of the filmed fish by the frequency of its tail, measured and simulated."""

from pathlib import Path

from hasel_sim.mesh_picture import save_picture
from matplotlib.figure import Figure

from hasel_sysid.measured_fish.comparison import FishComparison


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
