"""What the benchmark asks of `improve`."""

from collections.abc import Sequence
from concurrent.futures import Executor

from hasel_sim.model import Model, load_model
from hasel_sysid.dataset import prepared
from hasel_sysid.experiment import Experiment
from hasel_sysid.improvement import improve
from hasel_sysid.problem import Problem

from hasel_benchmark.bench_hidden.generate import Laboratory


def explain(laboratory: Laboratory, pool: Executor) -> dict:
    """The content of `improve --json` for these measurements, starting from the default swimmer."""
    return answer(load_model("swimmer"), laboratory.fitted, laboratory.unseen, pool)


def answer(
    model: Model,
    fitted: Sequence[Experiment],
    unseen: Sequence[Experiment],
    pool: Executor,
) -> dict:
    """The content of `improve --json` for these experiments, starting from a model."""
    found = improve(Problem(fitted, pool), prepared(model, fitted), Problem(unseen, pool))
    return found.to_json()
