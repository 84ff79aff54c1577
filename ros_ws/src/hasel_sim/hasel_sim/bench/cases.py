"""What is measured: the default swimmer at 5.5 kV, 2 Hz, and meshes of it."""

import numpy as np

from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import Model, load_model
from hasel_sim.model_mesh import model_mesh
from hasel_sim.run import Run

FRAMES_PER_SECOND = 120.0


def fitted_swimmer() -> Model:
    """The default swimmer with amplitudes and slope near those that fit a real one."""
    model = load_model("swimmer").with_levels(np.array([3500.0, 4500.0, 5500.0]))
    amplitudes = {"amplitude_3500": 0.0268, "amplitude_4500": 0.0440, "amplitude_5500": 0.0624}
    return model.with_values({**amplitudes, "slope": 0.264})


def box_run(duration: float = 1.0, voltage: float = 5500.0, frequency: float = 2.0) -> Run:
    """Alternating boxes of voltage [V] at a frequency [Hz], upper muscle first, filmed for a duration [s]."""
    switches = np.arange(0.0, duration, 0.5 / frequency)
    upper = np.arange(len(switches)) % 2 == 0
    voltages = voltage * np.stack([upper, ~upper], axis=1).astype(float)
    frames = np.arange(round(duration * FRAMES_PER_SECOND) + 1) / FRAMES_PER_SECOND
    return Run("5.5 kV, 2 Hz", frames, DriveSchedule(switches, voltages))


def swimmer_with_every_force() -> Model:
    """The swimmer in oil with all effects of its fluid that may stand side by side."""
    model = load_model("swimmer_in_oil").with_effects("form_drag", "viscous_drag")
    further = {"form_drag.coefficient": 0.05, "viscous_drag.across": 4.0, "viscous_drag.along": 2.0}
    return model.with_values(further)


def node_count(model: Model) -> int:
    """Nodes of a model's mesh."""
    return len(model_mesh(model).nodes)


def with_nodes(model: Model, wanted: int) -> Model:
    """The model with the mesh density whose number of nodes comes nearest to the wanted one."""
    densities = np.arange(0.3, 8.0, 0.05)
    models = [model.with_numerics(mesh_density=float(density)) for density in densities]
    return min(models, key=lambda candidate: abs(node_count(candidate) - wanted))
