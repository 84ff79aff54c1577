"""The options that commands share."""

import argparse
import math
from pathlib import Path

from hasel_recording.command_line import RecordingsParser, add_reading_options

DEFAULT_MODEL = "swimmer"


def recording_options(
    prog: str,
    description: str,
    several_models: bool = False,
    effects: bool = False,
    noise: bool = False,
    everything: bool = False,
    recordings: str = "+",
    json: bool = True,
) -> argparse.ArgumentParser:
    """What commands on recordings share: what to read, the model, candidates, where to write, on how many cores.

    recordings: how many there must be, as of argparse's nargs.
    """
    parser = RecordingsParser(prog=prog, description=description)
    _add_recordings(parser, recordings)
    add_reading_options(parser)
    _add_model(parser, several_models)
    if effects:
        _add_effects(parser)
    if everything:
        parser.add_argument(
            "--all", action="store_true", help="print all tables and what is said of every effect"
        )
    if noise:
        _add_noise(parser)
    _add_results(parser, json)
    _add_workers(parser)
    return parser


def _add_recordings(parser: argparse.ArgumentParser, count: str) -> None:
    """Positional recordings and --validate."""
    parser.add_argument("recordings", metavar="RECORDING", nargs=count, type=Path, help=".mcap or .csv file")
    parser.add_argument(
        "--validate",
        metavar="RECORDING",
        nargs="+",
        type=Path,
        default=[],
        help="recordings that are never used for fitting or choosing",
    )


def _add_model(parser: argparse.ArgumentParser, several: bool) -> None:
    """--model; `several`: it may be given more than once."""
    parser.add_argument(
        "--model",
        metavar="NAME|FILE",
        action="append" if several else "store",
        help="model to use (default: what the recordings' header says, else swimmer)"
        + ("; give it again to compare several models" if several else ""),
    )


def _add_results(parser: argparse.ArgumentParser, json: bool) -> None:
    """--output and --json."""
    parser.add_argument(
        "--output",
        metavar="DIR",
        type=Path,
        default=Path(),
        help="folder for what is written (default: %(default)s)",
    )
    if json:
        parser.add_argument("--json", metavar="FILE", type=Path, help="write the results for other programs")


def _add_effects(parser: argparse.ArgumentParser) -> None:
    """--effects and --add."""
    parser.add_argument(
        "--effects",
        metavar="A,B",
        action="extend",
        type=_names,
        help="consider only these effects (ids, or path/to/file.py:ClassName); with a + before each, all known ones "
        "and these",
    )
    parser.add_argument(
        "--add",
        metavar="A,B",
        dest="effects",
        action="extend",
        type=lambda text: tuple(f"+{name.lstrip('+')}" for name in _names(text)),
        help="the same as --effects +A,+B: consider all known effects and these",
    )


def _names(text: str) -> tuple[str, ...]:
    return tuple(name.strip() for name in text.split(",") if name.strip())


def _add_noise(parser: argparse.ArgumentParser) -> None:
    """--noise."""
    parser.add_argument(
        "--noise",
        metavar="RMS",
        type=float,
        help="standard deviation of the noise of sin θ, where neither frames at rest nor repeated runs show it",
    )


def _add_workers(parser: argparse.ArgumentParser) -> None:
    """--jobs and --scheduler."""
    parser.add_argument(
        "--jobs", metavar="N", type=_at_least_one, help="simulations at once (default: one per core)"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="use the Dask scheduler at this address instead"
    )


def add_time_limit(parser: argparse.ArgumentParser) -> None:
    """--seconds."""
    parser.add_argument(
        "--seconds",
        metavar="N",
        type=_positive,
        default=math.inf,
        help="begin nothing more after so many seconds, and say what was not tried (default: no limit)",
    )


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
