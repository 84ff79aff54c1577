# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The moving body as one array of 32-bit numbers: nodes, strain and contraction, with the measured markers over it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from hasel_sim.mesh.mesh import Mesh, reference_gradients
from hasel_sim.model import Model
from hasel_sim.model_mesh import model_mesh
from hasel_sim.run import Simulation
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment
from hasel_sysid.report.shape import measured_tail

_RING = (0, 4, 1, 5, 2, 6, 3, 7)
"""An element's nodes around its edge: corner, mid-side, corner …"""
_FRAMES_PER_SECOND = 60.0
_I = np.array([1.0, 1.0j])
"""Makes complex numbers of vectors: their quotient is a turn and a stretch."""


@dataclass(frozen=True)
class Film:
    """frames [n, 1 + muscles + 6 + 6 + 2 nodes + elements]: time [s], contraction [1], simulated and measured head,
    middle, tail [m], nodes [m], and the stretch along the body at rest, F e_x, less one [1], of every element.

    rings [elements, 8]: nodes around each; muscle [elements]: number of the muscle that runs through it, from 1, or 0;
    skin [edges, 3]: nodes of the outline.
    """

    run: str
    frames: np.ndarray
    rings: np.ndarray
    muscle: np.ndarray
    skin: np.ndarray
    nodes: int
    muscles: int

    def header(self) -> dict[str, Any]:
        """What the numbers are, as plain words and numbers."""
        return {
            "run": self.run,
            "frames": len(self.frames),
            "width": self.frames.shape[1],
            "nodes": self.nodes,
            "muscles": self.muscles,
            "rings": self.rings.tolist(),
            "muscle": self.muscle.tolist(),
            "skin": self.skin.tolist(),
        }


def film(model: Model, experiment: Experiment, simulation: Simulation, offset: float) -> Film:
    """Of a simulation that kept its shapes; at most 60 frames a second.

    offset: of this run's measured sin theta, taken out before its direction is drawn.
    """
    mesh = model_mesh(model)
    usual = float(np.median(np.diff(simulation.time))) if len(simulation.time) > 1 else 1.0
    every = max(1, round(1.0 / (_FRAMES_PER_SECOND * usual))) if usual > 0 else 1
    shown = np.arange(0, len(simulation.time), every)
    if simulation.shapes is None:
        raise SysidError(f"the simulation of {experiment.name} kept no shapes; simulate it with them")
    shapes = simulation.shapes[shown]
    measured = measured_markers(experiment, simulation.markers, offset, model)[shown]
    count = len(shapes)
    parts = [
        simulation.time[shown][:, None],
        simulation.contraction[shown],
        simulation.markers[shown][:, :3].reshape(count, -1),
        measured.reshape(count, -1),
        shapes.reshape(count, -1),
        axial_strain(mesh, shapes),
    ]
    frames = np.concatenate(parts, axis=1).astype(np.float32)
    frames = frames[np.isfinite(shapes).all(axis=(1, 2))]
    outline = mesh.elements[:, _RING], mesh.muscle, mesh.skin
    return Film(experiment.name, frames, *outline, shapes.shape[1], simulation.contraction.shape[1])


def axial_strain(mesh: Mesh, shapes: np.ndarray) -> np.ndarray:
    """|F e_x| - 1 [n, elements], e_x along the body at rest, at each element's middle, for nodes [m] [n, nodes, 2]."""
    _, gradients, _ = reference_gradients(mesh.nodes[mesh.elements], 1)
    along = np.einsum("neai,ea->nei", shapes[:, mesh.elements], gradients[:, 0, :, 0])
    return np.linalg.norm(along, axis=-1) - 1.0


def measured_markers(
    experiment: Experiment, simulated: np.ndarray, offset: float, model: Model
) -> np.ndarray:
    """Head, middle and tail as measured, [m] [n, 3, 2], in the simulated body's frame; NaN where not measured.

    simulated [m] [n, markers, 2]; offset: of the measured sin theta, taken out where only the angle is known.
    A clamped body's markers lie where they were measured. A free body's place in the image is not simulated: its head
    and middle marker are laid on the simulated ones, in size as in direction, and the tail shows what differs. Where
    only the angle was recorded the tail is drawn at the simulated distance, in the measured direction.
    """
    head, middle = simulated[:, 0], simulated[:, 1]
    recorded = experiment.recording.angle_markers
    fixed = any(marker.fixed for marker in model.description.markers.values())
    is_held = fixed or model.description.body.clamped
    if recorded is not None and experiment.recording.marker_unit == "m" and is_held:
        return recorded.copy()
    if recorded is None:
        end = measured_tail(simulated, experiment.sin_theta - offset)
    else:
        if experiment.recording.marker_unit == "px":
            recorded = recorded * (1.0, -1.0)
        first, second = recorded[:, 1] - recorded[:, 0], recorded[:, 2] - recorded[:, 1]
        turned = ((middle - head) @ _I) * (second @ _I) / (first @ _I)
        end = middle + np.stack([turned.real, turned.imag], axis=-1)
    known = np.isfinite(end).all(axis=-1)[:, None]
    return np.stack([np.where(known, head, np.nan), np.where(known, middle, np.nan), end], axis=1)
