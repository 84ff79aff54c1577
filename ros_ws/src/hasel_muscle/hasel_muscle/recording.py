"""What a bench recorded of one muscle."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

Held = Literal["load", "contraction"]


@dataclass(frozen=True)
class BenchRecording:
    """Samples at times [s] [n]: voltage [V], contraction [m], load [N] and, where measured, current [A], all [n].

    held: what the bench keeps, a hanging load or the contraction (a clamped length); the other one is the answer.
    contraction and load may be NaN where a sensor saw nothing.
    """

    name: str
    time: np.ndarray
    voltage: np.ndarray
    contraction: np.ndarray
    load: np.ndarray
    current: np.ndarray | None = None
    held: Held = "load"
    path: Path | None = None
    metadata: dict[str, str] = field(default_factory=dict)
    understood: tuple[str, ...] = ()

    @property
    def answer(self) -> np.ndarray:
        """What the muscle does: contraction [m] under a load, load [N] at a held contraction."""
        return self.contraction if self.held == "load" else self.load

    def __str__(self) -> str:
        rate = 1 / np.median(np.diff(self.time))
        peak = np.nanmax(np.abs(self.answer - self.answer[0]))
        shown = f"{1e3 * peak:.3g} mm" if self.held == "load" else f"{peak:.3g} N"
        return (
            f"{self.name}: {len(self.time)} samples in {self.time[-1] - self.time[0]:.4g} s ({rate:.4g} per s), "
            f"{self.held} held, up to {np.abs(self.voltage).max():.5g} V, moves up to {shown}"
        )
