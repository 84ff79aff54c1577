"""What the benchmark asks of `improve`."""

from concurrent.futures import Executor

from hasel_sim.model import load_model
from hasel_sysid.improve import improve

from hasel_bringup.bench_hidden.generate import Laboratory


def explain(laboratory: Laboratory, pool: Executor) -> dict:
    """The content of `improve --json` for these measurements, starting from the default swimmer."""
    result = improve(load_model("swimmer"), laboratory.fitted, pool, validation=laboratory.unseen)
    return result.as_dict()
