"""The options of `live_demo`, without anything that takes time to import."""

import argparse
from pathlib import Path

from hasel_bringup.errors import BringupError
from hasel_bringup.hidden_truth.hidden import MEANING, RANDOM, check_hidden


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="live_demo",
        description="Virtual supply, driver, camera, tracker, simulator, identification and recorder as nodes: "
        "measure, learn what the model misses, add it to the running simulator, and open the secret.",
    )
    options.add_argument(
        "--hidden",
        default=RANDOM,
        type=_hidden,
        metavar="A,B",
        help=f"{MEANING} (default: %(default)s)",
    )
    options.add_argument("--seed", type=int, default=-1, help="of what is random; -1: another one each time")
    options.add_argument(
        "--output",
        type=Path,
        default=Path("output") / "live_demo",
        metavar="DIR",
        help="(default: %(default)s)",
    )
    options.add_argument(
        "--runs", type=int, metavar="N", help="only the N shortest runs, without learning anything from them"
    )
    options.add_argument(
        "--attach", action="store_true", help="use nodes that run already, as virtual.launch.py does"
    )
    return options


def _hidden(text: str) -> str:
    try:
        check_hidden(text.split(","))
    except BringupError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    return text
