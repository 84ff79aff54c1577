# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A laboratory with recordings of a swimmer that has what the model lacks, on a coarse model."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hasel_recording import Recording, write_recording
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import Model, load_model, save_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

COARSE = {"mesh_density": 0.5, "quadrature_order": 2, "steps_per_second": 120.0}
TRUTH = {"mesh_density": 0.8, "quadrature_order": 2, "steps_per_second": 480.0, "spectral_radius": 1.0}
VALUES = {"amplitude_3500": 0.027, "amplitude_5500": 0.062, "slope": 0.3}
CONDITIONS = ((3500.0, 1.0), (3500.0, 2.0), (5500.0, 1.0), (5500.0, 2.0), (4500.0, 1.5))


@dataclass(frozen=True)
class Laboratory:
    """Where the recordings and the model without the effect lie."""

    folder: Path
    effect: str

    def arguments(self, rivals: str) -> list[str]:
        """Of any command: four fitted runs, the coarse model, and the effect among its rivals as candidates."""
        fitted = sorted(str(path) for path in self.folder.glob("[35]*V*.csv"))
        model = ["--model", str(self.folder / "coarse.yaml"), "--jobs", "1"]
        return [*fitted, *model, "--effects", f"{self.effect},{rivals}"]


def coarse_swimmer() -> Model:
    """The swimmer on a mesh and with steps that are soon simulated."""
    return load_model("swimmer").with_numerics(**COARSE)


def write_boxes(
    truth: Model, path: Path, voltage: float, frequency: float, periods: float, seed: int
) -> None:
    """Record alternating boxes of a voltage [V] with white noise as a CSV file."""
    frames = np.arange(0, periods / frequency, 1 / 120)
    side = np.mod(frames * frequency, 1) < 0.5
    drive = voltage * np.column_stack([side, ~side])
    angle = simulate(truth, Run("r", frames, DriveSchedule(frames, drive))).sin_theta
    noise = 0.002 * np.random.default_rng(seed).normal(size=len(frames))
    write_recording(Recording(path.stem, frames, angle + noise, drive), path)


def laboratory(folder: Path, effect: str, values: dict[str, float]) -> Laboratory:
    """Record a swimmer with an effect, on another mesh and with other time steps than the model's."""
    save_model(coarse_swimmer(), folder / "coarse.yaml")
    truth = load_model("swimmer").with_numerics(**TRUTH).with_levels(np.array([3500.0, 5500.0]))
    truth = truth.with_effects(effect).with_values({**VALUES, **values})
    for seed, (voltage, frequency) in enumerate(CONDITIONS):
        write_boxes(truth, folder / f"{voltage:.0f}V_{frequency:g}Hz.csv", voltage, frequency, 2, seed)
    return Laboratory(folder, effect)


@pytest.fixture(scope="session")
def coarse() -> Model:
    """The swimmer on a mesh and with steps that are soon simulated."""
    return coarse_swimmer()


@pytest.fixture(scope="session")
def record_boxes() -> Callable[..., None]:
    """Records a model under alternating boxes."""
    return write_boxes


@pytest.fixture(scope="session")
def record() -> Callable[..., Laboratory]:
    """Makes a laboratory."""
    return laboratory


@pytest.fixture(scope="session")
def with_drag(tmp_path_factory) -> Laboratory:
    """A swimmer in a liquid that the model leaves out."""
    return laboratory(tmp_path_factory.mktemp("drag"), "quadratic_drag", {"quadratic_drag.coefficient": 0.25})
