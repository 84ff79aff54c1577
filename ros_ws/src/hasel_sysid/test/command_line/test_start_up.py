# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Commands start at once: nothing is imported that a command does not need."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from hasel_sysid.command_line import options
from hasel_sysid.estimation import METHODS

HEAVY = ("torch", "statsmodels", "scipy.stats", "scipy.signal", "pandas", "dask")


def imported_by(statement: str) -> set[str]:
    """Modules that a fresh interpreter holds after a statement."""
    program = f"{statement}\nimport json, sys\nprint(json.dumps(sorted(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    return set(json.loads(done.stdout.splitlines()[-1]))


def test_compare_imports_nothing_that_it_does_not_use():
    """A second of processor and 200 MB each: no torch, statsmodels or scipy.stats for a comparison."""
    assert not imported_by("import hasel_sysid.command_line.compare") & set(HEAVY)


def test_help_needs_neither_simulator_nor_scipy():
    """The executables read their options before anything heavy is imported."""
    found = imported_by("import hasel_sysid.command_line.options")
    assert not {
        name for name in found if name.split(".")[0] in ("scipy", "numba", "torch", "hasel_sim", "plotly")
    }


@pytest.mark.parametrize(
    "name",
    [
        *("check", "compare", "fit", "diagnose", "improve", "suggest"),
        *("measured_fish", "add", "remove"),
    ],
)
def test_every_executable_has_its_options(name, monkeypatch, capsys):
    """Each entry point answers --help by its own name."""
    monkeypatch.setattr(sys, "argv", [name, "--help"])
    with pytest.raises(SystemExit) as left:
        getattr(options, name)()
    assert left.value.code == 0
    assert capsys.readouterr().out.startswith(f"usage: {name} ")


def test_the_methods_of_fit_are_all_there():
    """The choices are written out so that --help need not import the methods."""
    assert sorted(METHODS) == list(options.FIT_METHODS)


RUNS = sorted((Path(__file__).resolve().parents[5] / "data" / "unseen_rig" / "quadratic_drag").glob("*.csv"))
SECONDS, MEGABYTES, SLOWER = 3.0, 300.0, 5.0
"""Of processor and of memory that comparing twelve runs may take; how much slower a busy machine may count."""


def used(*arguments: str) -> tuple[float, float]:
    """Processor time [s] and largest memory [MB] of a fresh interpreter and all that it starts."""
    program = (
        "import resource, subprocess, sys\n"
        "subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)\n"
        "used = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
        "print(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)"
    )
    command = [sys.executable, "-c", program, sys.executable, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    seconds, megabytes = map(float, done.stdout.split())
    return seconds, megabytes


def test_comparing_twelve_runs_takes_seconds(tmp_path):
    """Loops compiled before; the report is written too."""
    compare = ("-m", "hasel_sysid.command_line.compare", *map(str, RUNS), "--output", str(tmp_path))
    used(*compare)
    seconds, megabytes = used(*compare)
    assert len(RUNS) == 12
    assert seconds < SLOWER * SECONDS
    assert megabytes < 1.2 * MEGABYTES
    assert (tmp_path / "report.html").stat().st_size < 2_000_000


def test_help_takes_a_part_of_a_second():
    """Of any command."""
    program = (
        "import sys; sys.argv = ['improve', '--help']\n"
        "from hasel_sysid.command_line.options import improve\nimprove()"
    )
    assert used("-c", program)[0] < SLOWER * 0.5
