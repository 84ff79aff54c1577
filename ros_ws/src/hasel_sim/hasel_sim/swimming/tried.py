"""Swimmers that were tried, and the best of them."""

from dataclasses import dataclass, field

import numpy as np

from hasel_sim.model import Model
from hasel_sim.swimming.boxes import Boxes
from hasel_sim.swimming.task import Task

_REACHED = np.radians(0.1)
"""How far [rad, rad/s] a turning or heading may be from what is wanted."""


@dataclass(frozen=True)
class Tried:
    """A swimmer with what it came to.

    speed [m/s], turning [rad/s], heading at the end [rad], power [W] and the mass it moved [kg]; body: what of it was
    varied, in words; values: of the parameters that were.
    """

    drive: Boxes
    speed: float
    turning: float
    power: float
    mass: float
    heading: float = 0.0
    body: str = ""
    values: dict[str, float] = field(default_factory=dict, compare=False)

    @property
    def cost_of_transport(self) -> float:
        """Work per mass and distance [J/(kg m)]."""
        return self.power / (self.mass * self.speed) if self.speed > 0 else np.inf

    def __str__(self) -> str:
        body = f", {self.body}" if self.body else ""
        return (
            f"{self.drive}, duty {self.drive.duty:.3f}, phase {self.drive.phase:.3f}{body}: "
            f"{1e3 * self.speed:.2f} mm/s, {np.degrees(self.turning):+.3f}°/s, heading "
            f"{np.degrees(self.heading):+.2f}°, {self.cost_of_transport:.3g} J/(kg m)"
        )


@dataclass(frozen=True)
class BestSwim:
    """The start and the best, and everything that was tried on the way."""

    start: Tried
    best: Tried
    tried: tuple[Tried, ...] = field(repr=False)
    task: Task

    @property
    def missed(self) -> str:
        """A sentence about a turning or heading that was asked for and is not reached; empty where all is."""
        for name, unit in (("turning", "°/s"), ("heading", "°")):
            wanted, reached = getattr(self.task, name), getattr(self.best, name)
            if wanted is not None and abs(reached - wanted) > _REACHED:
                return (
                    f"The {name} of {np.degrees(wanted):g}{unit} is not reached, only {np.degrees(reached):.3g}{unit}: "
                    "let more vary, in wider ranges or for longer."
                )
        return ""

    def __str__(self) -> str:
        told = f"from {self.start}\nto   {self.best}\nafter {len(self.tried)} swims with gradients."
        return f"{told} {self.missed}".rstrip()

    def improved(self, model: Model) -> Model:
        """A model with the body that was found, as a file of its own would describe it."""
        changed = model.with_freed(*self.best.values).with_values(self.best.values)
        return changed.with_constants_settled(
            *(name for name in self.best.values if name not in model.parameters)
        )
