"""The sequence of time steps between the frames of a recording."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.mechanics.generalised_alpha import StepCoefficients, step_coefficients


@dataclass(frozen=True)
class StepPlan:
    """Step boundaries [s] [steps + 1], the index of each frame among them [frames], and every step's coefficients."""

    boundaries: np.ndarray
    frames: np.ndarray
    coefficients: list[StepCoefficients]

    @property
    def balance_times(self) -> np.ndarray:
        """Instant [s] in each step at which forces are balanced, [steps]."""
        return np.array(
            [start + c.at for start, c in zip(self.boundaries[:-1], self.coefficients, strict=True)]
        )


def plan_steps(
    frame_times: np.ndarray, steps_per_second: float, rho: float, start: float, end: float
) -> StepPlan:
    """Equal steps, about `steps_per_second` of them, between neighbouring frames [s] and on to `end` [s].

    Frame times come rounded and jitter a little; a tenth of a step too long is not worth another step.
    """
    marks = np.unique(np.concatenate([[start], frame_times, [max(end, frame_times[-1])]]))
    counts = np.maximum(1, np.ceil(np.diff(marks) * steps_per_second - 0.1).astype(int))
    ends = np.cumsum(counts)
    frames = np.concatenate([[0], ends])[np.searchsorted(marks, frame_times)]
    lengths = np.repeat(np.diff(marks) / counts, counts)
    back = np.repeat(ends, counts) - np.arange(1, counts.sum() + 1)
    boundaries = np.concatenate([marks[:1], np.repeat(marks[1:], counts) - back * lengths])
    rounded = np.round(lengths, 10).tolist()
    by_length = {length: step_coefficients(length, rho) for length in set(rounded)}
    return StepPlan(boundaries, frames, [by_length[length] for length in rounded])
