"""Processor time of one thread: what the work costs, whatever else the machine is doing."""

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

import numpy as np

_FIRST_RUN = """
import time
import numpy as np
from hasel_sim.bench.cases import box_run, fitted_swimmer
from hasel_sim.simulate import simulate
start = time.perf_counter()
simulate(fitted_swimmer(), box_run(0.02), ["slope"])
print(time.perf_counter() - start)
"""


def processor_seconds(work: Callable[[], object], repeats: int) -> float:
    """Median processor time [s] of a call, after one call that is not counted."""
    work()
    times = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return float(np.median(times))


def first_run_seconds() -> float:
    """Wall time [s] of the first simulation on a machine that has compiled nothing yet."""
    with tempfile.TemporaryDirectory() as cache:
        environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
        output = subprocess.run(
            [sys.executable, "-c", _FIRST_RUN], env=environment, check=True, capture_output=True, text=True
        )
    return float(output.stdout)
