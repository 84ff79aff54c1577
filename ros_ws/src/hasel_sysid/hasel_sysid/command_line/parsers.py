"""The options of every command, without anything that takes time to import."""

import argparse
from pathlib import Path

from hasel_recording.command_line import RecordingsParser, add_reading_options

from hasel_sysid.command_line.options import DEFAULT_MODEL, add_time_limit, recording_options

FIT_METHODS = ("adam", "least_squares")


def compare_parser() -> argparse.ArgumentParser:
    """Options of `compare`."""
    return recording_options("compare", "Compare a model with recordings.", several_models=True)


def fit_parser() -> argparse.ArgumentParser:
    """Options of `fit`."""
    options = recording_options("fit", "Identify a model's parameters from recordings.")
    options.add_argument(
        "--method",
        choices=FIT_METHODS,
        default="least_squares",
        help="least_squares, or the seed paper's Adam (default: %(default)s)",
    )
    return options


def diagnose_parser() -> argparse.ArgumentParser:
    """Options of `diagnose`."""
    what = "Rank the effects that a model may lack."
    options = recording_options("diagnose", what, effects=True, noise=True, everything=True)
    add_time_limit(options)
    return options


def improve_parser() -> argparse.ArgumentParser:
    """Options of `improve`."""
    what = "Add missing effects until what is left is noise or nothing known explains it."
    options = recording_options("improve", what, effects=True, noise=True, everything=True)
    add_time_limit(options)
    return options


def suggest_parser() -> argparse.ArgumentParser:
    """Options of `suggest`."""
    what = "Propose the next run: the one in which the remaining explanations differ most."
    options = recording_options("suggest", what, effects=True, noise=True)
    options.add_argument(
        "--max-voltage",
        "--max-level",
        metavar="LEVEL",
        dest="max_level",
        type=float,
        help="highest safe level of the drive, in its SI unit (default: 5500 V; of other quantities the highest one "
        "that was recorded)",
    )
    return options


def check_parser() -> argparse.ArgumentParser:
    """Options of `check`."""
    options = RecordingsParser(
        prog="check",
        description="Say what was understood of recordings (rate, angle, drive, markers, start) and what looks wrong, "
        "before anything is fitted. Exit code 0: nothing with which results would mislead.",
    )
    options.add_argument("recordings", metavar="RECORDING", nargs="+", type=Path, help=".mcap or .csv file")
    add_reading_options(options)
    options.add_argument(
        "--model", metavar="NAME|FILE", help="say too whether the drive's channels fit this model"
    )
    options.add_argument("--json", metavar="FILE", type=Path, help="write the same for other programs")
    return options


def _effects_parser(name: str, description: str, joint: str) -> argparse.ArgumentParser:
    options = argparse.ArgumentParser(prog=name, description=description)
    options.add_argument(
        "effects", metavar="EFFECT", nargs="*", help="id of an effect, or path/to/file.py:ClassName"
    )
    options.add_argument(
        "--model",
        metavar="NAME|FILE",
        default=DEFAULT_MODEL,
        help="model to start from (default: %(default)s)",
    )
    options.add_argument(
        "--output",
        metavar="DIR|FILE",
        type=Path,
        default=Path(),
        help=f"folder, or .yaml file to write (default: MODEL{joint}EFFECT.yaml here)",
    )
    options.add_argument("--list", action="store_true", help="list the effects there are")
    return options


def add_parser() -> argparse.ArgumentParser:
    """Options of `add`."""
    return _effects_parser(
        "add", "Write a model with further effects, at values at which they do nothing.", "+"
    )


def remove_parser() -> argparse.ArgumentParser:
    """Options of `remove`."""
    return _effects_parser("remove", "Write a model without some of its effects.", "-")
