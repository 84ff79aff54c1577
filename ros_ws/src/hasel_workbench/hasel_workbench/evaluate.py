"""A model against all runs, with derivatives, as a step."""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor

from hasel_sim.model import Model
from hasel_sysid.estimation import FittedModel
from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Evaluation, Problem

from hasel_workbench.step import Step

Progress = Callable[[str, float], None]
"""Called with a line of text and the share done, 0 to 1; it raises where the work is no longer wanted."""


def silent(_text: str, _share: float) -> None:
    """Tell nobody."""


def evaluated(
    label: str,
    model: Model,
    experiments: Sequence[Experiment],
    unseen: Sequence[Experiment],
    pool: Executor,
    progress: Progress = silent,
    fit: FittedModel | None = None,
    did: tuple[str, ...] = (),
) -> Step:
    """Simulate all runs with a model and its derivatives by all free parameters.

    fit: of this very model, whose evaluation of the fitted runs is used. Raises SimulationError.
    """
    progress("simulating", 0.0)
    seen = fit.evaluation if fit is not None else Problem(experiments, pool).evaluate(model, model.free)
    progress("simulating", 0.6)
    others = Problem(unseen, pool).evaluate(model, model.free) if unseen else None
    progress("where it fails", 0.9)
    step = Step(label, model, tuple(experiments), tuple(unseen), seen, others, fit, did)
    step.comparison  # noqa: B018  worked out here, where waiting is no harm
    return step


def evaluation_of(step: Step, number: int) -> tuple[Evaluation, int]:
    """The evaluation that holds a run, by its number among all runs, and its number there."""
    count = len(step.experiments)
    return (step.seen, number) if number < count else (step.unseen, number - count)
