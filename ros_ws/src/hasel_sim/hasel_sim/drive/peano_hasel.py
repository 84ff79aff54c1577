"""The contraction that a voltage aims at, by the law of the Peano-HASEL against an elastic body."""

from collections.abc import Mapping

import numpy as np

from hasel_sim.model.muscle_law import GAIN, PRELOAD, STIFFNESS, MuscleLaw
from hasel_sim.muscle.muscle import Muscle

_BODY = "parallel_stiffness"


class PeanoHaselDrive:
    """The law of a model's muscles; the body's stiffness counts beside what the muscle itself opposes."""

    def __init__(self, law: MuscleLaw) -> None:
        muscle = law.muscle()
        own = f"{_BODY}.stiffness"
        self._own_stiffness = muscle.values.get(own, 0.0)
        self._muscle = muscle if own in muscle.parameters else muscle.with_effects(_BODY)

    def contraction(self, voltage: np.ndarray, values: Mapping[str, float]) -> np.ndarray:
        """Contraction [1] aimed at for voltages [V] of any shape."""
        muscle = self._beside_the_body(values)
        flat = np.ravel(voltage)
        load = np.full(flat.shape, values[PRELOAD])
        strain = muscle.balanced(flat, load, load) / muscle.rest_length
        return values[GAIN] * strain.reshape(np.shape(voltage))

    def onset(self, values: Mapping[str, float]) -> float:
        """Voltage [V] up to which the preload holds the muscle at its full length."""
        return self._beside_the_body(values).onset(values[PRELOAD])

    def _beside_the_body(self, values: Mapping[str, float]) -> Muscle:
        return self._muscle.with_values({f"{_BODY}.stiffness": self._own_stiffness + values[STIFFNESS]})
