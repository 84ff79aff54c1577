# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Benches that never were: lifts of a muscle with a secret, written as the files that a bench writes."""

from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
import pytest
from hasel_sim.model.muscle_file import load_muscle
from hasel_sim.muscle.muscle import Muscle

VOLTAGES = (1500.0, 2000.0, 2500.0, 3000.0, 3500.0, 4000.0, 4500.0, 5000.0)


@dataclass
class MadeUpBench:
    """Staircase lifts of 4 s with rests of 3 s, 50 samples per second, noise of a micrometre and a millinewton."""

    muscle: Muscle = field(default_factory=lambda: load_muscle("peano_hasel"))
    voltages: tuple[float, ...] = VOLTAGES
    load: float = 0.5
    noise: float = 1e-6
    seed: int = 0

    def hiding(self, **values: float) -> "MadeUpBench":
        """The same muscle with an effect, by its parameters as effect__parameter."""
        names = {key.replace("__", "."): value for key, value in values.items()}
        for effect in dict.fromkeys(name.partition(".")[0] for name in names):
            self.muscle = self.muscle.with_effects(effect)
        self.muscle = self.muscle.with_values(names)
        return self

    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times [s], voltages [V] and contractions [m] with noise."""
        time = np.arange(0.0, 2.0 + 7.0 * len(self.voltages), 0.02)
        number = np.floor((time - 2.0) / 7.0).astype(int)
        on = (time >= 2.0) & ((time - 2.0) % 7.0 < 4.0)
        voltage = np.where(on, np.array(self.voltages)[np.clip(number, 0, len(self.voltages) - 1)], 0.0)
        x = self.muscle.contraction(time, voltage, np.full(len(time), self.load))
        return time, voltage, x + np.random.default_rng(self.seed).normal(0.0, self.noise, len(time))

    def write_csv(self, path: Path) -> Path:
        """Times in s, kilovolts, millimetres; the load in the header."""
        time, voltage, x = self.samples()
        rows = [f"{t:.3f},{1e-3 * v:.4f},{1e3 * c:.6f}" for t, v, c in zip(time, voltage, x, strict=True)]
        path.write_text(f"#load_n: {self.load}\ntime_s,voltage_kv,contraction_mm\n" + "\n".join(rows) + "\n")
        return path

    def write_force_csv(self, path: Path, contraction: float) -> Path:
        """Forces [N] at a held contraction [m]."""
        time, voltage, _ = self.samples()
        force = self.muscle.force(time, voltage, np.full(len(time), contraction))
        force = force + np.random.default_rng(self.seed).normal(0.0, 1e-3, len(time))
        rows = [
            f"{t:.3f},{v:.1f},{1e3 * contraction:.4f},{f:.6f}"
            for t, v, f in zip(time, voltage, force, strict=True)
        ]
        path.write_text(
            "#held: contraction\ntime_s,voltage_v,contraction_mm,load_n\n" + "\n".join(rows) + "\n"
        )
        return path

    def write_mat(self, folder: Path) -> Path:
        """The public repository's way: volts of a data logger in a MATLAB 7.3 file, dimensions beside it."""
        time, voltage, x = self.samples()
        current = np.gradient(voltage, time) * 1e-9
        table = np.stack([time, voltage / 2000.0, 4.0 + x / 4e-3, voltage / 2000.0 + 0.004, current / 2e-3])
        table[2, 500] = 0.01  # the laser saw nothing
        path = folder / "post_process" / "raw_data" / f"{1e3 * self.load / 9.80665:.4g}g__step_made_up.mat"
        path.parent.mkdir(parents=True)
        with h5py.File(path, "w") as file:
            file["data"] = table
        pouch, count = self.muscle.pouch, self.muscle.count
        (folder / "parameters.py").write_text(
            f"import os  # never run\nn_pouches = {count}\nLp = {pouch.film_length}*n_pouches #Total length\n"
            f"Le = {pouch.electrode_length}*n_pouches\nw = {pouch.width}\nt = {pouch.film_thickness}\n"
            f"eps_0 = 8.85e-12\neps_r = {pouch.relative_permittivity}\nraise SystemExit('this file was run')\n"
        )
        return path


@pytest.fixture
def bench():
    """A bench whose muscle is the package's own, until it hides something."""
    return MadeUpBench()
