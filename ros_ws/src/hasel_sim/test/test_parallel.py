"""Many runs by one code path."""

import subprocess
import sys

import numpy as np
import pytest
from hasel_sim.errors import ModelError, SimulationError
from hasel_sim.parallel import SerialExecutor, executor, simulate_all
from hasel_sim.simulate import simulate


def test_processes_give_what_one_process_gives(swimmer, boxes):
    """In the order of the runs, whatever their lengths."""
    runs = [boxes(duration=d) for d in (0.1, 0.3, 0.2)]
    with executor(jobs=2) as pool:
        found = simulate_all(pool, swimmer, runs, ["slope"])
    for run, simulation in zip(runs, found, strict=True):
        expected = simulate(swimmer, run, ["slope"])
        assert simulation.sin_theta == pytest.approx(expected.sin_theta, abs=1e-9)
        assert simulation.slopes == pytest.approx(expected.slopes, abs=1e-6)


def test_one_job_runs_in_this_process():
    """Errors come back through the future."""
    with executor(jobs=1) as pool:
        assert isinstance(pool, SerialExecutor)
        assert pool.submit(sum, [1, 2]).result() == 3
        with pytest.raises(ZeroDivisionError):
            pool.submit(divmod, 1, 0).result()


def test_an_error_in_another_process_keeps_its_sentence(swimmer, boxes):
    """A ModelError survives the way back."""
    with executor(jobs=2) as pool, pytest.raises(ModelError, match="not a parameter"):
        simulate_all(pool, swimmer, [boxes(duration=0.1)], ["nothing"])


_BUSY = """
import time
from hasel_sim.parallel import executor
with executor(jobs=2) as pool:
    print(pool.submit(abs, -1).result(), flush=True)
    for future in [pool.submit(time.sleep, 60) for _ in range(3)]:
        future.result()
"""


def test_workers_end_with_a_parent_that_is_killed():
    """In the middle of a task, instead of keeping the cores busy; the output they share is closed when all ended."""
    parent = subprocess.Popen([sys.executable, "-c", _BUSY], stdout=subprocess.PIPE, text=True)
    assert parent.stdout.readline() == "1\n"
    parent.kill()
    parent.communicate(timeout=20)


def test_a_scheduler_that_does_not_answer_is_reported():
    """One sentence with the address and what to start."""
    with (
        pytest.raises(SimulationError, match="no Dask scheduler answers at"),
        executor(scheduler="tcp://127.0.0.1:1"),
    ):
        pass


def test_a_dask_scheduler_gives_the_same(swimmer, boxes):
    """A cluster on this machine."""
    from distributed import LocalCluster

    with (
        LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster,
        executor(scheduler=cluster.scheduler_address) as pool,
    ):
        found = simulate_all(pool, swimmer, [boxes(duration=0.1)])
    assert found[0].sin_theta == pytest.approx(simulate(swimmer, boxes(duration=0.1)).sin_theta, abs=1e-9)
    assert np.isfinite(found[0].sin_theta).all()
