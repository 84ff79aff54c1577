"""The deformation gradient of a motion and its rate, found when asked for: few effects ask for the rate."""

from functools import cached_property

import numpy as np

from hasel_sim.mechanics.motion import Motion
from hasel_sim.mechanics.solid import Solid


class Strained:
    """A `Solid` at one motion; arrays are [elements, points, 4, lanes]."""

    def __init__(self, solid: Solid, motion: Motion) -> None:
        self.solid, self.motion = solid, motion

    @property
    def places(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """What the compiled loops know of the mesh."""
        return self.solid.places

    @cached_property
    def F(self) -> np.ndarray:
        """Deformation gradient [1]."""
        return self.solid.gradient(self.motion.position)

    @cached_property
    def rate(self) -> np.ndarray:
        """Its rate [1/s]."""
        return self.solid.gradient(self.motion.velocity)
