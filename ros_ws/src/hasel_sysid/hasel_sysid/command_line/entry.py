"""Where the executables begin: options are read before anything heavy is imported, so that --help answers at once."""

import argparse
import gc
import sys
from collections.abc import Callable
from importlib import import_module

from hasel_common.command_entry import command

from hasel_sysid.command_line import parsers, specimen_parsers


@command
def check() -> int:
    """`check RECORDING…`."""
    return _run(parsers.check_parser, "check")


@command
def compare() -> int:
    """`compare RECORDING…`."""
    return _run(parsers.compare_parser, "compare")


@command
def fit() -> int:
    """`fit RECORDING…`."""
    return _run(parsers.fit_parser, "fit")


@command
def diagnose() -> int:
    """`diagnose RECORDING…`."""
    return _run(parsers.diagnose_parser, "diagnose")


@command
def improve() -> int:
    """`improve RECORDING…`."""
    return _run(parsers.improve_parser, "improve")


@command
def suggest() -> int:
    """`suggest RECORDING…`."""
    return _run(parsers.suggest_parser, "suggest")


@command
def measured_fish() -> int:
    """`measured_fish DIR`."""
    return _run(specimen_parsers.measured_fish_parser, "measured_fish")


@command
def add() -> int:
    """`add EFFECT…`."""
    return _run(parsers.add_parser, "effects", "run_add")


@command
def remove() -> int:
    """`remove EFFECT…`."""
    return _run(parsers.remove_parser, "effects", "run_remove")


def _run(parser: Callable[[], argparse.ArgumentParser], module: str, function: str = "run") -> int:
    options = parser().parse_args(sys.argv[1:])
    code = getattr(import_module(f"hasel_sysid.command_line.{module}"), function)(options)
    gc.freeze()  # the process ends: looking once more for what could be collected takes 0.3 s
    return code
