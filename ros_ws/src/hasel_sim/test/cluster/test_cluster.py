# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A cluster that answers, one that cannot, and one that is lost in the middle."""

import os
import pickle
import signal
import socket
import time

import numpy as np
import pytest
from hasel_sim import cluster as clusters
from hasel_sim.cluster import cluster
from hasel_sim.errors import ClusterError
from hasel_sim.parallel import PACKAGES, executor, simulate_all

_BEGIN = """
import os, time
try:
    os.close(os.open(marker, os.O_CREAT | os.O_EXCL))
except FileExistsError:
    pass
else:
    time.sleep(60)
"""
"""Long the first time that it is run, wherever that is."""

JOINING_S = 20.0


@pytest.fixture
def hurried(monkeypatch):
    """So long a worker may take to join, or to come back."""

    def to(seconds: float) -> None:
        monkeypatch.setattr(clusters, "JOIN_S", seconds)

    return to


def _begun(marker) -> None:
    """Wait until a task said that it has begun."""
    end = time.monotonic() + JOINING_S
    while not marker.exists():
        assert time.monotonic() < end
        time.sleep(0.02)


def test_two_workers_give_the_same_answer_to_the_last_digit(processes, swimmer, boxes):
    """As one process, though that simulates other runs side by side."""
    for _ in range(2):
        processes.worker()
    runs = [boxes(duration=d) for d in (0.1, 0.16, 0.12, 0.14, 0.18, 0.2)]
    with executor(jobs=1) as pool:
        alone = simulate_all(pool, swimmer, runs, ["slope"])
    with executor(scheduler=processes.address) as pool:
        _until(lambda: pool.workers == 2)
        found = simulate_all(pool, swimmer, runs, ["slope"])
    for one, other in zip(alone, found, strict=True):
        assert np.array_equal(one.sin_theta, other.sin_theta)
        assert np.array_equal(one.slopes, other.slopes)


def _until(reached) -> None:
    end = time.monotonic() + JOINING_S
    while not reached():
        assert time.monotonic() < end
        time.sleep(0.05)


def test_what_takes_calls_and_says_nothing_is_no_scheduler(monkeypatch):
    """Another program at the address, after a time limit."""
    monkeypatch.setattr(clusters, "ANSWER_S", 0.5)
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(ClusterError, match="no Dask scheduler answers at"), cluster(address, PACKAGES):
            pass


def test_a_scheduler_without_workers_is_one_sentence(processes, hurried):
    """With what to start, after a time limit."""
    hurried(0.3)
    with (
        pytest.raises(ClusterError, match=r"has no worker after 0.3 s; start one with `dask worker tcp://"),
        cluster(processes.address, PACKAGES),
    ):
        pass


def test_workers_without_the_code_or_with_another_get_no_work(processes, hurried, tmp_path, capsys):
    """None fits: one sentence, with what was found and expected. A fitting one joins later: it does all the work."""
    hurried(JOINING_S)
    processes.worker(path="")
    with (
        pytest.raises(
            ClusterError,
            match=r"none of .* fits .* lacks hasel_common, hasel_sim; expected hasel_common .*; start them",
        ),
        cluster(processes.address, PACKAGES),
    ):
        pass
    fitting = processes.worker()
    processes.wait_for(2)
    with cluster(processes.address, PACKAGES) as pool:
        assert pool.workers == 1
        for name in PACKAGES:  # another revision, which joins while the command goes on
            (tmp_path / "other" / name).mkdir(parents=True)
            (tmp_path / "other" / name / "__init__.py").write_text("'''Another revision.'''")
        processes.worker(path=str(tmp_path / "other"))
        said = ""
        while said.count("gets no work") < 2:
            time.sleep(0.1)
            said += capsys.readouterr().err
        assert {pool.submit(os.getpid).result() for _ in range(8)} == {fitting.pid}
    first, second = said.strip().splitlines()
    assert "gets no work: it lacks hasel_common, hasel_sim; expected" in first
    assert "gets no work: it has hasel_common" in second
    assert "; start it in an environment of this workspace" in second


def test_a_worker_killed_in_the_middle_loses_nothing(processes, tmp_path):
    """The other one, or one that joins when all are gone, does its part."""
    first = processes.worker()
    with cluster(processes.address, PACKAGES) as pool:
        marker = tmp_path / "begun"
        futures = [pool.submit(exec, _BEGIN, {"marker": str(marker)}) for _ in range(3)]
        _begun(marker)
        first.kill()
        processes.worker()
        assert [future.result(timeout=JOINING_S) for future in futures] == [None] * 3


def test_lost_workers_are_one_sentence_after_a_time_limit(processes, hurried, tmp_path):
    """What waits gets it, and what is asked for afterwards."""
    worker = processes.worker()
    with cluster(processes.address, PACKAGES) as pool:
        hurried(0.5)
        futures = [pool.submit(exec, _BEGIN, {"marker": str(tmp_path / "begun")}) for _ in range(2)]
        _begun(tmp_path / "begun")
        worker.kill()
        for future in futures:
            with pytest.raises(
                ClusterError, match=r"workers of .* were lost, .* none came back within 0.5 s"
            ):
                future.result(timeout=JOINING_S)
        with pytest.raises(ClusterError, match="were lost"):
            pool.submit(abs, -1)


def test_a_task_that_kills_its_workers_is_one_sentence(processes, monkeypatch):
    """Instead of killing all that come after them."""
    monkeypatch.setattr(clusters, "LOSSES", 0)
    processes.worker()
    with cluster(processes.address, PACKAGES) as pool:
        future = pool.submit(os._exit, 1)
        _until(lambda: pool.workers == 0)
        processes.worker()
        with pytest.raises(ClusterError, match=r"lost with every worker of .* that began it"):
            future.result(timeout=JOINING_S)


@pytest.mark.parametrize("ends_by", [signal.SIGKILL, signal.SIGSTOP])
def test_a_lost_scheduler_is_one_sentence(processes, monkeypatch, tmp_path, ends_by):
    """Whether its process has ended or is silent."""
    monkeypatch.setattr(clusters, "SILENCE_S", 1.0)
    processes.worker()
    with cluster(processes.address, PACKAGES) as pool:
        future = pool.submit(exec, _BEGIN, {"marker": str(tmp_path / "begun")})
        _begun(tmp_path / "begun")
        processes.scheduler.send_signal(ends_by)
        with pytest.raises(ClusterError, match=r"scheduler at .* was lost: start it and its workers"):
            future.result(timeout=JOINING_S)


def test_an_error_of_a_task_comes_back_as_it_is(processes):
    """A wrong call is not the cluster's fault."""
    processes.worker()
    with cluster(processes.address, PACKAGES) as pool:
        with pytest.raises(ZeroDivisionError):
            pool.submit(divmod, 1, 0).result(timeout=JOINING_S)
        with pytest.raises(FileNotFoundError):
            pool.submit(os.stat, "/nowhere").result(timeout=JOINING_S)
        with pytest.raises((AttributeError, TypeError, pickle.PicklingError)):
            pool.submit(lambda: 1).result(timeout=JOINING_S)
        assert pool.submit(sum, [1, 2]).result(timeout=JOINING_S) == 3
