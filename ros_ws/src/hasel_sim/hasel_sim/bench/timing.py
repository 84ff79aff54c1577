"""Processor time of one thread: what the work costs, whatever else the machine is doing."""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence

import numpy as np

_FIRST_RUN = """
import time
import numpy as np
from hasel_sim.bench.cases import box_run, fitted_swimmer
from hasel_sim.simulate import simulate
start = time.process_time()
simulate(fitted_swimmer(), box_run(0.02), ["slope"])
print(time.process_time() - start)
"""


def processor_seconds(works: Sequence[Callable[[], object]], repeats: int) -> list[float]:
    """Median processor time [s] of a call of each, after one that is not counted.

    They take turns, so that a machine whose speed drifts is as fast for one as for another.
    """
    times = [[_seconds(work) for work in works] for _ in range(1 + repeats)]
    return np.median(times[1:], axis=0).tolist()


def _seconds(work: Callable[[], object]) -> float:
    start = time.process_time()
    work()
    return time.process_time() - start


def first_run_seconds() -> float:
    """Processor time [s] of the first simulation on a machine that has compiled nothing yet."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
        output = subprocess.run(
            [sys.executable, "-c", _FIRST_RUN], env=environment, check=True, capture_output=True, text=True
        )
    return float(output.stdout)
