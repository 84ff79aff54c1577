"""A picture of a body's mesh: its regions, muscles, spine and markers."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from hasel_sim.build import marker_points, model_mesh
from hasel_sim.errors import ModelError
from hasel_sim.mesh.mesh import Mesh, Region
from hasel_sim.model import Model

SUFFIXES = (".png", ".svg", ".pdf")
COLOURS = {
    Region.SOFT: ("#d9d2c5", "soft, no muscle"),
    Region.SPINE: ("#44505c", "spine and fin"),
    Region.UPPER_MUSCLE: ("#d9654b", "upper muscle"),
    Region.LOWER_MUSCLE: ("#4b86b4", "lower muscle"),
}
_AROUND = [0, 4, 1, 5, 2, 6, 3, 7]
"""Local nodes of an element in the order of its edge."""


def draw_mesh(model: Model) -> Figure:
    """A figure of the body at rest, to scale, in millimetres."""
    mesh = model_mesh(model)
    width, height = 1e3 * np.ptp(mesh.nodes, axis=0)
    figure = Figure(figsize=(12, float(np.clip(1.6 + 11 * height / width, 2.2, 9))), layout="constrained")
    axes = figure.add_subplot()
    _add_elements(axes, mesh)
    _add_nodes(axes, mesh)
    _add_markers(axes, model)
    axes.set_aspect("equal")
    axes.margins(0.02, 0.15)
    axes.set_xlabel("x, along the body at rest [mm]")
    axes.set_ylabel("y [mm]")
    elements, nodes = len(mesh.elements), len(mesh.nodes)
    axes.set_title(f"{model.name}: {elements} elements, {nodes} nodes")
    present = [region for region in COLOURS if region in mesh.region]
    patches = [Patch(color=COLOURS[region][0], label=_name(model, region)) for region in present]
    handles = patches + axes.get_legend_handles_labels()[0]
    figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), frameon=False)
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


def _name(model: Model, region: Region) -> str:
    return COLOURS[region][1] if model.has_muscles else "body"


def _add_elements(axes, mesh: Mesh) -> None:
    outlines = 1e3 * mesh.nodes[mesh.elements[:, _AROUND]]
    colours = [COLOURS[Region(region)][0] for region in mesh.region]
    axes.add_collection(
        PolyCollection(list(outlines), facecolors=colours, edgecolors="white", linewidths=0.5)
    )


def _add_nodes(axes, mesh: Mesh) -> None:
    x, y = 1e3 * mesh.nodes.T
    axes.plot(x, y, ".", color="black", markersize=1.5)
    if len(mesh.clamped):
        axes.plot(x[mesh.clamped], y[mesh.clamped], "s", color="black", markersize=5, label="clamped")


def _add_markers(axes, model: Model) -> None:
    for point, name in zip(1e3 * marker_points(model), ("head", "middle", "tail"), strict=True):
        label = "markers" if name == "head" else None
        axes.plot(*point, "o", color="#2ca02c", markeredgecolor="white", markersize=9, label=label)
        axes.annotate(name, point, (0, 9), textcoords="offset points", ha="center", fontsize=9)
