"""On how many cores a command computes."""

import os
from types import SimpleNamespace

import pytest
from hasel_sysid.command_line import workers
from hasel_sysid.errors import SysidError


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


@pytest.mark.parametrize(
    ("known", "has", "said"),
    [(0, {}, "has no worker; start one with"), (1, {"tcp://a:1": False}, "have not got this code")],
)
def test_a_cluster_is_asked_first(monkeypatch, known, has, said):
    """Without workers, or with workers that lack the code, one sentence instead of waiting for ever."""

    class Client:
        def __init__(self, *_, **__): ...
        def __enter__(self):
            return self

        def __exit__(self, *_): ...
        def wait_for_workers(self, *_, **__):
            if not known:
                raise TimeoutError

        def run(self, *_):
            return has

    monkeypatch.setattr("distributed.Client", Client)
    options = SimpleNamespace(jobs=None, scheduler="tcp://127.0.0.1:8786")
    with pytest.raises(SysidError, match=said), workers.workers(options):
        pass
