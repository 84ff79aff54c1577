"""The error falling, step by step, on fitted and on unseen runs."""

from dataclasses import dataclass

from hasel_sysid.report.content import StageRow

from hasel_workbench.state import SessionState

_RMS_TO_MEAN = 0.798
"""Mean magnitude of Gaussian noise of unit standard deviation."""


@dataclass(frozen=True)
class Waterfall:
    """stages: of all steps up to the current one, and of what is being tried, if anything is; noise_floor: mean |noise|
    of sin theta, by the last diagnosis, else by the fastest part of the measured angle.
    """

    stages: tuple[StageRow, ...]
    tried: bool
    noise_floor: float


def waterfall(state: SessionState) -> Waterfall:
    """Of a session with at least one step."""
    steps = [*state.kept, *([state.trial] if state.trial else [])]
    stages = tuple(StageRow(step.label, step.error, step.error_unseen, step.file) for step in steps)
    return Waterfall(stages, state.trial is not None, noise_floor(state))


def noise_floor(state: SessionState) -> float:
    """Mean magnitude of the noise of sin theta, as far as it is known."""
    if state.diagnosis is not None:
        return state.diagnosis.measured.mean_absolute
    return _RMS_TO_MEAN * state.shown.comparison.where.noise
