# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Errors are one sentence on stderr with exit code 2, warnings one line."""

import json
import os
import warnings
from contextlib import contextmanager
from types import SimpleNamespace

import numpy as np
import pytest
from hasel_recording import RecordingError, RecordingWarning
from hasel_sim.errors import ModelError, SimulationError
from hasel_sysid.command_line import running
from hasel_sysid.command_line.running import run_command, write_json
from hasel_sysid.errors import SysidError


@pytest.mark.parametrize(
    "error",
    [
        RecordingError("no file"),
        ModelError("no model"),
        SimulationError("no motion"),
        SysidError("no run"),
        FileNotFoundError(2, "No such file or directory", "x.json"),
    ],
)
def test_errors_are_one_sentence(capsys, error):
    """No stack trace, one line, exit code 2."""

    def fail():
        raise error

    assert run_command(fail) == 2
    said = capsys.readouterr().err
    assert said.startswith("error: ")
    assert said.count("\n") == 1


def test_bugs_are_not_hidden(tmp_path, monkeypatch, capsys):
    """An error that nobody foresaw is not dressed up as bad input: it has a code of its own, and a file to send."""
    monkeypatch.chdir(tmp_path)
    assert run_command(lambda: 1 / 0) == 70
    assert "ZeroDivisionError" in capsys.readouterr().err
    assert [path.name[:11] for path in tmp_path.iterdir()] == ["hasel_error"]


def test_warnings_are_one_line(capsys):
    """A skipped recording is said in one line and does not stop the command."""
    code = run_command(lambda: warnings.warn("Skipped: x.csv", RecordingWarning, stacklevel=1))
    assert (code, capsys.readouterr().err) == (0, "warning: Skipped: x.csv\n")


def test_interrupt_has_its_own_code(capsys):
    """Ctrl-C ends with 130, as in a shell."""

    def interrupted():
        raise KeyboardInterrupt

    assert run_command(interrupted) == 130
    assert capsys.readouterr().err == "stopped\n"


def test_json_knows_no_nan(tmp_path):
    """NaN becomes null and numpy's numbers plain ones, so that every reader takes the file."""
    path = tmp_path / "new" / "results.json"
    write_json({"a": np.float64("nan"), "b": np.int64(3), "c": np.array([1.5, np.inf]), 2: (True, "θ")}, path)
    read = json.loads(path.read_text(encoding="utf-8"), parse_constant=lambda text: pytest.fail(text))
    assert read == {"a": None, "b": 3, "c": [1.5, None], "2": [True, "θ"]}


def test_only_the_cores_that_may_be_used_count(monkeypatch):
    """taskset, SLURM and a container's quota, whichever is least; at least one."""
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(6)), raising=False)
    monkeypatch.setattr(running, "_quota", lambda: "")
    monkeypatch.delenv("SLURM_CPUS_PER_TASK", raising=False)
    assert running.usable_cores() == 6
    monkeypatch.setenv("SLURM_CPUS_PER_TASK", "4")
    assert running.usable_cores() == 4
    monkeypatch.setattr(running, "_quota", lambda: "2")
    assert running.usable_cores() == 2


def test_a_cluster_must_have_the_sources_of_what_is_called_there(monkeypatch):
    """Those of identification too."""
    asked = {}

    @contextmanager
    def executor(jobs, scheduler, packages):
        asked.update(scheduler=scheduler, packages=packages)
        yield

    monkeypatch.setattr(running, "executor", executor)
    with running.workers(SimpleNamespace(jobs=None, scheduler="tcp://127.0.0.1:8786")):
        assert asked["scheduler"] == "tcp://127.0.0.1:8786"
    assert {"hasel_common", "hasel_recording", "hasel_sim", "hasel_sysid"} == set(asked["packages"])
