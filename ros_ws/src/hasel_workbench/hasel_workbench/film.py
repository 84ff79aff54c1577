"""The moving body as one array of 32-bit numbers: nodes, strain and contraction, with the measured markers over it."""

from dataclasses import dataclass

import numpy as np
from hasel_sim.mesh.mesh import Mesh, reference_gradients
from hasel_sim.model import Model
from hasel_sim.model_mesh import model_mesh
from hasel_sim.run import Simulation
from hasel_sysid.experiment import Experiment

from hasel_workbench.measured_markers import measured_markers

_RING = (0, 4, 1, 5, 2, 6, 3, 7)
"""An element's nodes around its edge: corner, mid-side, corner …"""
_FRAMES_PER_SECOND = 60.0


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

    def header(self) -> dict:
        """What the numbers are, as plain words and numbers."""
        return {
            "run": self.run,
            "frames": len(self.frames),
            "width": self.frames.shape[1],
            "nodes": self.nodes,
            "muscles": self.muscles,
            "rings": self.rings.tolist(),
            "muscle": self.muscle.tolist(),
            "skin": self.skin[:, [0, 1, 2]].tolist(),
        }


def film(model: Model, experiment: Experiment, simulation: Simulation, offset: float) -> Film:
    """Of a simulation that kept its shapes; at most 60 frames a second.

    offset: of this run's measured sin theta, taken out before its direction is drawn.
    """
    mesh = model_mesh(model)
    shown = _shown(simulation.time)
    shapes = simulation.shapes[shown]
    simulated = simulation.markers[shown][:, :3]
    measured = measured_markers(experiment, simulation.markers, offset, model)[shown]
    count = len(shapes)
    parts = [
        simulation.time[shown][:, None],
        simulation.contraction[shown],
        simulated.reshape(count, -1),
        measured.reshape(count, -1),
        shapes.reshape(count, -1),
        axial_strain(mesh, shapes),
    ]
    frames = np.concatenate(parts, axis=1).astype(np.float32)
    frames = frames[np.isfinite(shapes).all(axis=(1, 2))]
    return Film(
        experiment.name,
        frames,
        mesh.elements[:, _RING],
        mesh.muscle,
        mesh.skin,
        shapes.shape[1],
        simulation.contraction.shape[1],
    )


def axial_strain(mesh: Mesh, shapes: np.ndarray) -> np.ndarray:
    """|F e_x| - 1 [n, elements], e_x along the body at rest, at each element's middle, for nodes [m] [n, nodes, 2]."""
    _, gradients, _ = reference_gradients(mesh.nodes[mesh.elements], 1)
    along = np.einsum("neai,ea->nei", shapes[:, mesh.elements], gradients[:, 0, :, 0])
    return np.linalg.norm(along, axis=-1) - 1.0


def _shown(time: np.ndarray) -> np.ndarray:
    """Numbers of the frames that are shown."""
    usual = float(np.median(np.diff(time))) if len(time) > 1 else 1.0
    every = max(1, round(1.0 / (_FRAMES_PER_SECOND * usual))) if usual > 0 else 1
    return np.arange(0, len(time), every)
