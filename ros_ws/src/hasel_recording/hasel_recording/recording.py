"""One run of an experiment in memory."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

MARKER_NAMES = ("head", "middle", "tail")
MAXIMUM_VOLTAGE = 10_000.0  # [V], what the supply can give


@dataclass(frozen=True)
class Recording:
    """A run: the voltage on the muscles and the bending that was measured, frame by frame.

    name: short name, unique enough for a table; path: the file it came from.
    metadata: the header lines, such as `model` or `initial_time_s`, as text.
    time_s: [n], increasing.
    sin_theta: [n]; NaN in a frame in which a marker was lost.
    voltage: [n, 2] in V, signed, upper and lower muscle, each row holding until the next; None: passive body.
    markers: [n, 3, 2], head, middle and tail, x and y, in `marker_unit`; None when not recorded.
    marker_unit: "m" (y up) or "px" (y down, as in an image).
    drive_time_s [m], drive_voltage [m, 2]: the exact instants at which the voltage changed and what it
    changed to, where these do not all coincide with frames; otherwise None.
    simulated_time_s, simulated_sin_theta: [k], what a simulator said during the run; None when not recorded.
    """

    name: str
    time_s: np.ndarray
    sin_theta: np.ndarray
    voltage: np.ndarray | None = None
    markers: np.ndarray | None = None
    marker_unit: str = "m"
    metadata: dict[str, str] = field(default_factory=dict)
    path: Path | None = None
    drive_time_s: np.ndarray | None = None
    drive_voltage: np.ndarray | None = None
    simulated_time_s: np.ndarray | None = None
    simulated_sin_theta: np.ndarray | None = None

    @property
    def duration_s(self) -> float:
        """Time from the first to the last frame [s]."""
        return float(self.time_s[-1] - self.time_s[0])

    @property
    def valid(self) -> np.ndarray:
        """Which frames have an angle, [n]."""
        return np.isfinite(self.sin_theta)

    def drive(self) -> tuple[np.ndarray, np.ndarray]:
        """Return (times [s] [m], voltages [V] [m, 2]), each voltage holding until the next time.

        The passive body's drive is 0 V from the first frame on.
        """
        if self.drive_time_s is not None:
            return self.drive_time_s, self.drive_voltage
        if self.voltage is not None:
            return self.time_s, self.voltage
        return self.time_s[:1], np.zeros((1, 2))

    def __str__(self) -> str:
        frames = len(self.time_s)
        text = f"{self.name}: {frames} frames in {self.duration_s:.3g} s"
        if frames > 1:
            text += f" ({1 / np.median(np.diff(self.time_s)):.4g} frames/s)"
        lost = frames - int(self.valid.sum())
        text += f", {lost} without an angle" if lost else ""
        _, voltage = self.drive()
        text += f", up to {np.abs(voltage).max():.5g} V" if voltage.any() else ", passive"
        return text + (
            f", |sin θ| up to {np.abs(self.sin_theta[self.valid]).max():.3g}" if lost < frames else ""
        )
