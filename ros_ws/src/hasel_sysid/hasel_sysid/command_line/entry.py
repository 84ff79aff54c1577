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
    return run_module(parsers.check_parser, "hasel_sysid.command_line.check")


@command
def compare() -> int:
    """`compare RECORDING…`."""
    return run_module(parsers.compare_parser, "hasel_sysid.command_line.compare")


@command
def fit() -> int:
    """`fit RECORDING…`."""
    return run_module(parsers.fit_parser, "hasel_sysid.command_line.fit")


@command
def diagnose() -> int:
    """`diagnose RECORDING…`."""
    return run_module(parsers.diagnose_parser, "hasel_sysid.command_line.diagnose")


@command
def improve() -> int:
    """`improve RECORDING…`."""
    return run_module(parsers.improve_parser, "hasel_sysid.command_line.improve")


@command
def suggest() -> int:
    """`suggest RECORDING…`."""
    return run_module(parsers.suggest_parser, "hasel_sysid.command_line.suggest")


@command
def measured_fish() -> int:
    """`measured_fish DIR`."""
    return run_module(specimen_parsers.measured_fish_parser, "hasel_sysid.command_line.measured_fish")


@command
def add() -> int:
    """`add EFFECT…`."""
    return run_module(parsers.add_parser, "hasel_sysid.command_line.effects", "run_add")


@command
def remove() -> int:
    """`remove EFFECT…`."""
    return run_module(parsers.remove_parser, "hasel_sysid.command_line.effects", "run_remove")


def run_module(parser: Callable[[], argparse.ArgumentParser], module: str, function: str = "run") -> int:
    """Read the options, then import the command's module and run it."""
    options = parser().parse_args(sys.argv[1:])
    code = getattr(import_module(module), function)(options)
    gc.freeze()  # the process ends: looking once more for what could be collected takes 0.3 s
    return code
