"""The options that commands share."""

import argparse
from collections.abc import Sequence
from pathlib import Path

from hasel_sim.model import Model, load_model

from hasel_sysid.dataset import Experiment, load_experiments

DEFAULT_MODEL = "swimmer"


def add_recordings(parser: argparse.ArgumentParser) -> None:
    """Positional recordings and --validate."""
    parser.add_argument("recordings", metavar="RECORDING", nargs="+", type=Path, help=".mcap or .csv file")
    parser.add_argument(
        "--validate",
        metavar="RECORDING",
        nargs="+",
        type=Path,
        default=[],
        help="recordings that are never used for fitting or choosing",
    )


def add_model(parser: argparse.ArgumentParser, several: bool = False) -> None:
    """--model; `several`: it may be given more than once."""
    parser.add_argument(
        "--model",
        metavar="NAME|FILE",
        action="append" if several else "store",
        help="model to use (default: what the recordings' header says, else swimmer)"
        + ("; give it again to compare several models" if several else ""),
    )


def add_results(parser: argparse.ArgumentParser) -> None:
    """--output and --json."""
    parser.add_argument(
        "--output",
        metavar="DIR",
        type=Path,
        default=Path(),
        help="folder for what is written (default: here)",
    )
    parser.add_argument("--json", metavar="FILE", type=Path, help="write the results for other programs")


def add_effects(parser: argparse.ArgumentParser) -> None:
    """--effects."""
    parser.add_argument(
        "--effects",
        metavar="A,B",
        type=lambda text: tuple(name.strip() for name in text.split(",") if name.strip()),
        help="consider only these effects (ids, or path/to/file.py:ClassName)",
    )


def add_workers(parser: argparse.ArgumentParser) -> None:
    """--jobs and --scheduler."""
    parser.add_argument(
        "--jobs", metavar="N", type=_at_least_one, help="simulations at once (default: one per core)"
    )
    parser.add_argument(
        "--scheduler", metavar="ADDRESS", help="use the Dask scheduler at this address instead"
    )


def _at_least_one(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text} is less than 1")
    return number


def load_all(
    options: argparse.Namespace,
) -> tuple[list[Experiment], list[Experiment]]:
    """The experiments to fit and the unseen ones. Raises RecordingError when there are none to read."""
    unseen = load_experiments(options.validate) if options.validate else []
    return load_experiments(options.recordings), unseen


def chosen_model(name: str | None, experiments: Sequence[Experiment]) -> tuple[str, Model]:
    """The model asked for, else the one all headers name, else the swimmer; with what to call it."""
    named = {experiment.recording.metadata.get("model") for experiment in experiments}
    header = named.pop() if len(named) == 1 else None
    name = name or header or DEFAULT_MODEL
    model = load_model(name)
    label = Path(name).stem if Path(name).suffix in (".yaml", ".yml") else name
    return label, model
