"""On how many cores a command computes."""

import os
from contextlib import contextmanager
from types import SimpleNamespace

from hasel_sysid.command_line import workers


def test_only_the_cores_that_may_be_used_count(monkeypatch):
    """taskset, SLURM and a container's quota, whichever is least; at least one."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(6)), raising=False)
    monkeypatch.setattr(workers, "_quota", lambda: "")
    monkeypatch.delenv("SLURM_CPUS_PER_TASK", raising=False)
    assert workers.usable_cores() == 6
    monkeypatch.setenv("SLURM_CPUS_PER_TASK", "4")
    assert workers.usable_cores() == 4
    monkeypatch.setattr(workers, "_quota", lambda: "2")
    assert workers.usable_cores() == 2


def test_a_cluster_must_have_the_sources_of_what_is_called_there(monkeypatch):
    """Those of identification too."""
    asked = {}

    @contextmanager
    def executor(jobs, scheduler, packages):
        asked.update(scheduler=scheduler, packages=packages)
        yield

    monkeypatch.setattr(workers, "executor", executor)
    with workers.workers(SimpleNamespace(jobs=None, scheduler="tcp://127.0.0.1:8786")):
        assert asked["scheduler"] == "tcp://127.0.0.1:8786"
    assert {"hasel_common", "hasel_recording", "hasel_sim", "hasel_sysid"} == set(asked["packages"])
