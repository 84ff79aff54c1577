"""Runs of which two angles are measured, each in a made-up world of its own."""

from dataclasses import dataclass

import numpy as np
from hasel_recording import Recording
from hasel_sim.model import Model
from hasel_sim.run import Simulation

from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Evaluation
from hasel_sysid.testing.made_up_world import NOISE, MadeUpProblem, MadeUpWorld


@dataclass(frozen=True)
class TwoMeasured(Experiment):
    """other: of the second angle."""

    other: Recording

    @property
    def outputs(self) -> np.ndarray:
        """Both angles, [n, 2]."""
        return np.column_stack([self.sin_theta, self.other.sin_theta[: len(self.run.time)]])


@dataclass(frozen=True)
class TwoSimulated(Simulation):
    """other: of the second angle."""

    other: Simulation | None = None

    @property
    def outputs(self) -> np.ndarray:
        """Both angles, [n, 2]."""
        return np.column_stack([self.sin_theta, self.other.sin_theta])

    @property
    def output_slopes(self) -> np.ndarray:
        """Their derivatives, [n, 2, parameters]."""
        return np.stack([self.slopes, self.other.slopes], axis=1)


class TwoOutputs(MadeUpProblem):
    """Measured runs of two worlds in which a model's parameters move one angle each."""

    def __init__(self, first: MadeUpWorld, second: MadeUpWorld, truth: Model, noise: float = NOISE) -> None:
        """truth: as of `MadeUpWorld.measured`."""
        one, other = first.measured(truth, noise), second.measured(truth, noise)
        super().__init__(first, [e.sin_theta for e in one.experiments])
        self.second = second
        self.experiments = tuple(
            TwoMeasured(e.recording, e.run, o.recording)
            for e, o in zip(one.experiments, other.experiments, strict=True)
        )

    def _made_up(self, model: Model, names: tuple[str, ...]) -> Evaluation:
        both = (self.simulations(world, model, names) for world in (self.world, self.second))
        return self._collect(
            model,
            names,
            [TwoSimulated(**{**vars(one), "other": other}) for one, other in zip(*both, strict=True)],
        )
