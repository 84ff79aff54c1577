"""Commands start at once: nothing is imported that a command does not need."""

import json
import subprocess
import sys

import pytest
from hasel_sysid.command_line import parsers
from hasel_sysid.fit import METHODS

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
    found = imported_by("import hasel_sysid.command_line.entry")
    assert not {
        name for name in found if name.split(".")[0] in ("scipy", "numba", "torch", "hasel_sim", "plotly")
    }


@pytest.mark.parametrize(
    "name", ["check", "compare", "fit", "diagnose", "improve", "suggest", "add", "remove"]
)
def test_every_executable_has_its_options(name, monkeypatch, capsys):
    """Each entry point answers --help by its own name."""
    from hasel_sysid.command_line import entry

    monkeypatch.setattr(sys, "argv", [name, "--help"])
    with pytest.raises(SystemExit) as left:
        getattr(entry, name)()
    assert left.value.code == 0
    assert capsys.readouterr().out.startswith(f"usage: {name} ")


def test_the_methods_of_fit_are_all_there():
    """The choices are written out so that --help need not import the methods."""
    assert sorted(METHODS) == list(parsers.FIT_METHODS)
