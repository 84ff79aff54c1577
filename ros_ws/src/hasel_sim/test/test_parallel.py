# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Many runs by one code path."""

import subprocess
import sys

import pytest
from hasel_sim.errors import ClusterError, ModelError
from hasel_sim.parallel import SerialExecutor, executor, simulate_all, submit_each
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


@pytest.mark.parametrize("jobs", [1, 2])
def test_models_side_by_side_give_what_each_gives_alone(jobs, swimmer, boxes):
    """Two values of one model, and another with other derivatives, of which one cannot be simulated."""
    runs, drag = [boxes(duration=d) for d in (0.1, 0.2)], swimmer.with_effects("linear_drag")
    models = [swimmer, swimmer.with_values({"slope": 20.0}), drag, swimmer]
    asked = [["slope"], ["slope"], ["linear_drag.rate"], ["nothing"]]
    with executor(jobs) as pool:
        futures = submit_each(pool, models, runs, asked)
        for model, names, of_runs in zip(models[:3], asked[:3], futures[:3], strict=True):
            for run, future in zip(runs, of_runs, strict=True):
                alone = simulate(model, run, names)
                assert future.result().sin_theta == pytest.approx(alone.sin_theta, abs=1e-9)
                assert future.result().slopes == pytest.approx(alone.slopes, abs=1e-6)
        for future in futures[3]:
            with pytest.raises(ModelError, match="not a parameter"):
                future.result()


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
        pytest.raises(ClusterError, match="no Dask scheduler answers at"),
        executor(scheduler="tcp://127.0.0.1:1"),
    ):
        pass
