"""A picture of the angle that everything is about: the bent body, its markers and θ."""

import matplotlib

matplotlib.use("Agg")
import numpy as np
from hasel_recording.recording import turn_between
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Patch

from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import ModelError
from hasel_sim.mesh_picture import AROUND, MARKER, element_colours, muscle_colour
from hasel_sim.model import Model
from hasel_sim.model_mesh import model_mesh
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

_HELD_S, _FRAMES_PER_SECOND = 0.5, 60.0
_BEHIND = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 2.0}
_GOES_ON = 0.6
"""How far the line from head to middle goes on beyond the middle, in its own length."""


def draw_angle(model: Model, level: float) -> Figure:
    """A figure of the body, to scale in millimetres, where its first drive held at a level has bent it most.

    level: of the drive, in its unit. Raises ModelError for a body that nothing drives.
    """
    if not model.channels:
        raise ModelError(f"nothing drives model '{model.name}'; draw it at rest, or name a body with muscles")
    model = model if len(model.levels) else model.with_levels([level])
    signal = np.zeros((1, len(model.channels)))
    signal[0, 0] = level
    frames = np.arange(0.0, _HELD_S, 1 / _FRAMES_PER_SECOND)
    seen = simulate(model, Run("held", frames, DriveSchedule(np.zeros(1), signal)), keep_shapes=True)
    most = int(np.nanargmax(np.abs(seen.sin_theta)))
    return _drawn(model, 1e3 * seen.shapes[most], 1e3 * seen.markers[most, :3])


def _drawn(model: Model, shape: np.ndarray, markers: np.ndarray) -> Figure:
    """shape [nodes, 2], markers [3, 2]: positions [mm]."""
    mesh = model_mesh(model)
    figure = Figure(figsize=(9, 3.2), layout="constrained")
    axes = figure.add_subplot()
    outlines = shape[mesh.elements[:, AROUND]]
    axes.add_collection(
        PolyCollection(list(outlines), facecolors=list(element_colours(mesh)), edgecolors="none")
    )
    head, middle, tail = markers
    beyond = middle + _GOES_ON * (middle - head)
    axes.plot(*np.array([head, middle]).T, color="black", linewidth=1.2)
    axes.plot(*np.array([middle, beyond]).T, color="black", linewidth=1.0, linestyle=":")
    axes.plot(*np.array([middle, tail]).T, color="black", linewidth=1.2)
    _add_arc(axes, middle, beyond - middle, tail - middle)
    for point, name in zip(markers, ("head", "middle", "tail"), strict=True):
        axes.plot(*point, "o", color=MARKER, markeredgecolor="white", markersize=11, zorder=3)
        axes.annotate(name, point, (0, 12), textcoords="offset points", ha="center")
    muscles = [
        Patch(color=muscle_colour(number), label=f"muscle {muscle.name}")
        for number, muscle in enumerate(model.description.muscles, start=1)
    ]
    axes.legend(handles=muscles, loc="lower right", frameon=False)
    axes.set_aspect("equal")
    axes.margins(0.05, 0.25)
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    return figure


def _add_arc(axes, centre: np.ndarray, first: np.ndarray, second: np.ndarray) -> None:
    """θ from one line to the other about a point, all [2]."""
    _, turn = turn_between(first, second)
    size = 0.8 * min(np.linalg.norm(first), np.linalg.norm(second))
    begin, sweep = np.degrees(np.arctan2(first[1], first[0])), np.degrees(turn)
    low, high = sorted((begin, begin + sweep))
    axes.add_patch(Arc(tuple(centre), 2 * size, 2 * size, theta1=low, theta2=high, linewidth=1.5))
    middle = np.radians(begin + 0.5 * sweep)
    place = centre + 1.12 * size * np.array([np.cos(middle), np.sin(middle)])
    axes.text(*place, f"θ = {sweep:.0f}°", ha="left", va="center", fontsize=13, bbox=_BEHIND)
