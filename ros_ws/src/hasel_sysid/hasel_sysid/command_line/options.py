# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The options of every command, each declared once, and the executables, without anything that takes time to import."""

import argparse
import gc
import math
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

from hasel_common.command_entry import command
from hasel_recording.command_line import RecordingsParser, add_reading_options

DEFAULT_MODEL = "swimmer"
FIT_METHODS = ("adam", "least_squares")


def recording_options(
    prog: str,
    description: str,
    several_models: bool = False,
    effects: bool = False,
    noise: bool = False,
    search: bool = False,
    recordings: str = "+",
    json: bool = True,
) -> argparse.ArgumentParser:
    """What commands on recordings share: what to read, the model, candidates, where to write, on how many cores.

    several_models: --model may be given again; effects, noise: of a command that has candidates, or judges by the
    noise; search: of one that takes long and says much; recordings: how many there must be, as of argparse's nargs.
    """
    parser = RecordingsParser(prog=prog, description=description)
    add = parser.add_argument
    add("recordings", metavar="RECORDING", nargs=recordings, type=Path, help=".mcap or .csv file")
    unseen = "recordings that are never used for fitting or choosing"
    add("--validate", metavar="RECORDING", nargs="+", type=Path, default=[], help=unseen)
    add_reading_options(parser)
    add(
        "--model",
        metavar="NAME|FILE",
        action="append" if several_models else "store",
        help="model to use (default: what the recordings' header says, else swimmer)"
        + ("; give it again to compare several models" if several_models else ""),
    )
    if effects:
        add(
            "--effects",
            metavar="A,B",
            action="extend",
            type=names,
            help="consider only these effects (ids, or path/to/file.py:ClassName); with a + before each, all known "
            "ones and these",
        )
        add(
            "--add",
            metavar="A,B",
            dest="effects",
            action="extend",
            type=lambda text: tuple(f"+{name.lstrip('+')}" for name in names(text)),
            help="the same as --effects +A,+B: consider all known effects and these",
        )
    if search:
        add("--all", action="store_true", help="print all tables and what is said of every effect")
    if noise:
        what = (
            "standard deviation of the noise of sin θ, where neither frames at rest nor repeated runs show it"
        )
        add("--noise", metavar="RMS", type=float, help=what)
    folder = "folder for what is written (default: %(default)s)"
    add("--output", metavar="DIR", type=Path, default=Path(), help=folder)
    if json:
        add("--json", metavar="FILE", type=Path, help="write the results for other programs")
    add("--jobs", metavar="N", type=_at_least_one, help="simulations at once (default: one per core)")
    add("--scheduler", metavar="ADDRESS", help="use the Dask scheduler at this address instead")
    if search:
        limit = "begin nothing more after so many seconds, and say what was not tried (default: no limit)"
        add("--seconds", metavar="N", type=_positive, default=math.inf, help=limit)
    return parser


def names(text: str) -> tuple[str, ...]:
    """Words with commas between them."""
    return tuple(name.strip() for name in text.split(",") if name.strip())


def numbers(text: str) -> tuple[float, ...]:
    """Numbers with commas between them. Raises ArgumentTypeError for another text."""
    try:
        return tuple(float(number) for number in names(text))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is no list of voltages, such as 2000,4000") from None


def _positive(text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not number > 0.0:
        raise argparse.ArgumentTypeError(f"{text!r} is no number of seconds above 0, such as 600")
    return number


def _at_least_one(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text} is no whole number from 1 on")
    return int(text)


def check_parser() -> argparse.ArgumentParser:
    """Options of `check`."""
    parser = RecordingsParser(
        prog="check",
        description="Say what was understood of recordings (rate, angle, drive, markers, start) and what looks wrong, "
        "before anything is fitted. Exit code 0: nothing with which results would mislead.",
    )
    add = parser.add_argument
    add("recordings", metavar="RECORDING", nargs="+", type=Path, help=".mcap or .csv file")
    add_reading_options(parser)
    add("--model", metavar="NAME|FILE", help="say too whether the drive's channels fit this model")
    add("--json", metavar="FILE", type=Path, help="write the same for other programs")
    return parser


def compare_parser() -> argparse.ArgumentParser:
    """Options of `compare`."""
    return recording_options("compare", "Compare a model with recordings.", several_models=True)


def fit_parser() -> argparse.ArgumentParser:
    """Options of `fit`."""
    parser = recording_options("fit", "Identify a model's parameters from recordings.")
    what = "least_squares, or the seed paper's Adam (default: %(default)s)"
    parser.add_argument("--method", choices=FIT_METHODS, default="least_squares", help=what)
    return parser


def diagnose_parser() -> argparse.ArgumentParser:
    """Options of `diagnose`."""
    what = "Rank the effects that a model may lack."
    return recording_options("diagnose", what, effects=True, noise=True, search=True)


def improve_parser() -> argparse.ArgumentParser:
    """Options of `improve`."""
    what = "Add missing effects until what is left is noise or nothing known explains it."
    return recording_options("improve", what, effects=True, noise=True, search=True)


def suggest_parser() -> argparse.ArgumentParser:
    """Options of `suggest`."""
    what = "Propose the next run: the one in which the remaining explanations differ most."
    parser = recording_options("suggest", what, effects=True, noise=True)
    parser.add_argument(
        "--max-voltage",
        "--max-level",
        metavar="LEVEL",
        dest="max_level",
        type=float,
        help="highest safe level of the drive, in its SI unit (default: 5500 V; of other quantities the highest one "
        "that was recorded)",
    )
    return parser


def measured_fish_parser() -> argparse.ArgumentParser:
    """Options of `measured_fish`."""
    parser = argparse.ArgumentParser(
        prog="measured_fish",
        description="Compare the speeds of a filmed robot fish, of the public repository srl-ethz/fishsim, with those "
        "that the forces of the fluid give it for how its tail beats, and check its drive.",
    )
    add, here = parser.add_argument, Path("measured_fish")
    add("folder", metavar="DIR", type=Path, help="a clone of the repository, or its folder of markers")
    which = "films, by the frequency in their name, that the drag of the head is fitted to (default: 1,1.75)"
    add("--fitted", metavar="HZ,HZ", type=numbers, default=(1.0, 1.75), help=which)
    folder = "folder for what is written (default: measured_fish)"
    add("--output", metavar="DIR", type=Path, default=here, help=folder)
    add("--json", metavar="FILE", type=Path, help="write the results for other programs")
    return parser


def _effects_parser(name: str, description: str, joint: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog=name, description=description)
    add = parser.add_argument
    add("effects", metavar="EFFECT", nargs="*", help="id of an effect, or path/to/file.py:ClassName")
    start = "model to start from (default: %(default)s)"
    add("--model", metavar="NAME|FILE", default=DEFAULT_MODEL, help=start)
    where = f"folder, or .yaml file to write (default: MODEL{joint}EFFECT.yaml here)"
    add("--output", metavar="DIR|FILE", type=Path, default=Path(), help=where)
    add("--list", action="store_true", help="list the effects there are")
    return parser


def add_parser() -> argparse.ArgumentParser:
    """Options of `add`."""
    what = "Write a model with further effects, at values at which they do nothing."
    return _effects_parser("add", what, "+")


def remove_parser() -> argparse.ArgumentParser:
    """Options of `remove`."""
    return _effects_parser("remove", "Write a model without some of its effects.", "-")


def run_module(parser: Callable[[], argparse.ArgumentParser], module: str, function: str = "run") -> int:
    """Read the options, then import the command's module and run it."""
    options = parser().parse_args(sys.argv[1:])
    code = getattr(import_module(module), function)(options)
    gc.freeze()  # the process ends: looking once more for what could be collected takes 0.3 s
    return code


def _executable(
    parser: Callable[[], argparse.ArgumentParser], module: str, function: str = "run"
) -> Callable[..., int]:
    return command(lambda: run_module(parser, f"hasel_sysid.command_line.{module}", function))


check = _executable(check_parser, "check")
compare = _executable(compare_parser, "compare")
fit = _executable(fit_parser, "fit")
diagnose = _executable(diagnose_parser, "diagnose")
improve = _executable(improve_parser, "improve")
suggest = _executable(suggest_parser, "suggest")
measured_fish = _executable(measured_fish_parser, "measured_fish")
add = _executable(add_parser, "effects", "run_add")
remove = _executable(remove_parser, "effects", "run_remove")
