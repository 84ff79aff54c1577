# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Pictures of a body: its mesh with regions, muscles and markers; and bent, with its markers and the angle θ."""

import matplotlib

matplotlib.use("Agg")
import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np
from hasel_recording.recording import turn_between
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Patch

from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import HaselSimError, ModelError
from hasel_sim.mesh.mesh import Mesh, Region
from hasel_sim.model import Model, load_model
from hasel_sim.model_mesh import marker_points, model_mesh
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

SUFFIXES = (".png", ".svg", ".pdf")
SOFT, SPINE, MARKER = "#d9d2c5", "#44505c", "#2ca02c"
MUSCLES = ("#d9654b", "#4b86b4", "#8a5fa8", "#c9a227", "#3f8f6b", "#b0547c")
"""Colours of the muscles in the model file's order, from the start again where there are more."""
HATCHES = ("//", "\\\\", "xx", "..")
AROUND = [0, 4, 1, 5, 2, 6, 3, 7]
"""Local nodes of an element in the order of its edge."""


def draw_mesh(model: Model) -> Figure:
    """A figure of the body at rest, to scale, in millimetres."""
    mesh = model_mesh(model)
    width, height = 1e3 * np.ptp(mesh.nodes, axis=0)
    figure = Figure(figsize=(12, float(np.clip(2.2 + 14 * height / width, 2.8, 9))), layout="constrained")
    axes = figure.add_subplot()
    handles = _add_elements(axes, mesh, model)
    _add_nodes(axes, mesh)
    _add_markers(axes, model)
    _add_loads(axes, mesh, model)
    axes.set_aspect("equal")
    axes.margins(0.04, 0.3)
    axes.set_xlabel("x, along the body at rest [mm]")
    axes.set_ylabel("y [mm]")
    elements, nodes = len(mesh.elements), len(mesh.nodes)
    axes.set_title(f"{model.name}: {elements} elements, {nodes} nodes")
    handles += axes.get_legend_handles_labels()[0]  # type: ignore[arg-type]
    figure.legend(handles=handles, loc="outside lower center", ncols=min(len(handles), 6), frameon=False)
    return figure


def save_picture(figure: Figure, path: Path) -> None:
    """Write a figure as PNG, SVG or PDF, by the file's ending. Raises ModelError for any other."""
    if path.suffix.lower() not in SUFFIXES:
        raise ModelError(
            f"'{path}' ends in '{path.suffix}'; expected {', '.join(SUFFIXES)}: give the picture such a name"
        )
    try:
        figure.savefig(path, dpi=160)
    except OSError as error:
        raise ModelError(
            f"'{path}' cannot be written ({error.strerror}); name a folder that exists"
        ) from None


def element_colours(mesh: Mesh) -> np.ndarray:
    """By region and muscle, [elements]."""
    colours = np.where(mesh.region == Region.SPINE, SPINE, SOFT).astype(object)
    for number in np.unique(mesh.muscle[mesh.muscle > 0]):
        colours[mesh.muscle == number] = muscle_colour(int(number))
    return colours


def muscle_colour(number: int) -> str:
    """Of a muscle, counted from 1."""
    return MUSCLES[(number - 1) % len(MUSCLES)]


def _add_elements(axes: Axes, mesh: Mesh, model: Model) -> list[Patch]:
    """Draw every element; what its colours and hatches mean comes back."""
    outlines = 1e3 * mesh.nodes[mesh.elements[:, AROUND]]
    description = model.description
    colours = element_colours(mesh)
    handles = [Patch(color=SOFT, label="soft" if model.has_muscles or model.has_spine else "body")]
    if model.has_spine:
        handles.append(Patch(color=SPINE, label="spine and fin"))
    for number, muscle in enumerate(description.muscles, start=1):
        colour = muscle_colour(number)
        handles.append(Patch(color=colour, label=f"muscle {muscle.name} ({muscle.channel})"))
    axes.add_collection(
        PolyCollection(list(outlines), facecolors=list(colours), edgecolors="white", linewidths=0.5)
    )
    for number, region in enumerate(description.body.regions, start=1):
        style: dict[str, Any] = {
            "facecolor": "none",
            "edgecolor": "#333333",
            "hatch": HATCHES[(number - 1) % len(HATCHES)],
        }
        axes.add_collection(PolyCollection(list(outlines[mesh.material == number]), linewidths=0.0, **style))
        handles.append(Patch(label=f"region {region.name}", linewidth=0.0, **style))
    return handles


def _add_nodes(axes: Axes, mesh: Mesh) -> None:
    x, y = 1e3 * mesh.nodes.T
    axes.plot(x, y, ".", color="black", markersize=1.5)
    if len(mesh.clamped):
        axes.plot(x[mesh.clamped], y[mesh.clamped], "s", color="black", markersize=5, label="clamped")


def _add_markers(axes: Axes, model: Model) -> None:
    points, names = 1e3 * marker_points(model), model.description.marker_names()
    for point, name in zip(points, names, strict=True):
        label = "markers" if name == names[0] else None
        axes.plot(*point, "o", color=MARKER, markeredgecolor="white", markersize=9, label=label)
        axes.annotate(name, point, (0, 9), textcoords="offset points", ha="center", fontsize=9)


def _add_loads(axes: Axes, mesh: Mesh, model: Model) -> None:
    """The plate on the tip, and an arrow along gravity."""
    plate = model.description.body.tip_plate
    if plate:
        axes.plot(
            *(1e3 * mesh.nodes[mesh.tip]).T,
            color="black",
            linewidth=4,
            label=f"tip plate, {plate.mass_kg_per_m:g} kg/m",
        )
    gravity = np.array(model.description.material.gravity_m_per_s2)
    size = np.linalg.norm(gravity)
    if size > 0:
        centre, half = np.array([0.93, 0.9]), np.array([0.03, 0.08]) * gravity / (2 * size)
        places: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "axes fraction"}
        axes.annotate("", centre + half, centre - half, arrowprops={"arrowstyle": "-|>"}, **places)
        axes.annotate(f"g = {size:.3g} m/s²", (0.9, 0.9), ha="right", va="center", xycoords="axes fraction")


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


def _add_arc(axes: Axes, centre: np.ndarray, first: np.ndarray, second: np.ndarray) -> None:
    """θ from one line to the other about a point, all [2]."""
    _, turn = turn_between(first, second)
    size = 0.8 * min(np.linalg.norm(first), np.linalg.norm(second))
    begin, sweep = np.degrees(np.arctan2(first[1], first[0])), np.degrees(turn)
    low, high = sorted((begin, begin + sweep))
    axes.add_patch(Arc(tuple(centre), 2 * size, 2 * size, theta1=low, theta2=high, linewidth=1.5))
    middle = np.radians(begin + 0.5 * sweep)
    place = centre + 1.12 * size * np.array([np.cos(middle), np.sin(middle)])
    axes.text(place[0], place[1], f"θ = {sweep:.0f}°", ha="left", va="center", fontsize=13, bbox=_BEHIND)


def run(options: argparse.Namespace) -> int:
    """`show_mesh`: write the picture; 0, or 1 with a sentence about what is wrong."""
    try:
        model = load_model(options.model)
        if options.density is not None:
            model = model.with_numerics(mesh_density=options.density)
        path = options.output or Path(f"{model.name}_mesh.png")
        save_picture(draw_mesh(model) if options.bent is None else draw_angle(model, options.bent), path)
    except HaselSimError as error:
        print(f"show_mesh: {error}", file=sys.stderr)
        return 1
    print(f"Drew {path}.")
    return 0
