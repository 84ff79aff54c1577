# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where the executables begin: options are read before anything heavy is imported, so that --help answers at once."""

import argparse
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path

from hasel_common.command_entry import command


def numbers(text: str) -> tuple[float, ...]:
    """Numbers from "1,2.5,4" or from "first:last:step", last included. Raises ArgumentTypeError."""
    try:
        if ":" not in text:
            found = [float(part) for part in text.split(",")]
        else:
            first, last, step = (float(part) for part in text.split(":"))
            found = [first + n * step for n in range(int((last - first) / step + 1e-9) + 1)]
    except (ValueError, ZeroDivisionError):
        found = []
    if not found or not all(0 < number < float("inf") for number in found):
        raise argparse.ArgumentTypeError(
            f"'{text}' is neither a list nor a range; expected numbers above 0, such as 1,2,3 or 1:10:0.5"
        )
    return tuple(round(number, 12) for number in found)


def voltages(text: str) -> tuple[tuple[float, float], ...]:
    """Pairs of voltages [V] from "3500,5500/4800". Raises ArgumentTypeError."""
    pairs = []
    for part in text.split(","):
        first, _, second = part.partition("/")
        found = (*numbers(first), *numbers(second or first))
        if len(found) != 2:
            raise argparse.ArgumentTypeError(
                f"'{text}' is no list of voltages; expected such as 3500,4500 or 5500/4800, in V"
            )
        pairs.append((found[0], found[1]))
    return tuple(pairs)


def positive(text: str) -> float:
    """A number above 0. Raises ArgumentTypeError."""
    found = numbers(text)
    if len(found) != 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not one number; expected one above 0")
    return found[0]


def assignment(text: str) -> tuple[str, float]:
    """Name and value from "name=value". Raises ArgumentTypeError."""
    name, _, value = text.partition("=")
    try:
        return name.strip(), float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"'{text}' sets nothing; expected PARAMETER=VALUE, such as body.depth_m=0.04"
        ) from None


def free_range(text: str) -> tuple[str, tuple[float, ...]]:
    """Name and values from "name=low:high" or "name=low:high:count". Raises ArgumentTypeError."""
    name, _, values = text.partition("=")
    try:
        low, high, *count = values.split(":")
        pieces = int(count[0]) - 1 if count else 2
        first, last = float(low), float(high)
        if pieces < 1 or not first < last or len(count) > 1:
            raise ValueError
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"'{text}' is no range of a parameter; expected PARAMETER=LOW:HIGH or PARAMETER=LOW:HIGH:COUNT, such as "
            "body.depth_m=0.03:0.06"
        ) from None
    return name.strip(), tuple(first + (last - first) * n / pieces for n in range(pieces + 1))


def varied(text: str) -> dict[str, tuple[float, float] | None]:
    """Names with their ranges, None for the usual one, from "name,name=low:high". Raises ArgumentTypeError."""
    found: dict[str, tuple[float, float] | None] = {}
    for part in text.split(","):
        name, given, values = part.strip().partition("=")
        try:
            low, high = map(float, values.split(":")) if given else (0.0, 1.0)
            if not low < high:
                raise ValueError
        except ValueError:
            raise argparse.ArgumentTypeError(
                f"'{part}' is no range; expected NAME or NAME=LOW:HIGH, such as body.depth_m=0.03:0.06"
            ) from None
        found[name] = (low, high) if given else None
    return found


def bench_parser() -> argparse.ArgumentParser:
    """Options of `bench`."""
    options = argparse.ArgumentParser(prog="bench", description="Speed beside its bars, or convergence.")
    what = options.add_mutually_exclusive_group()
    what.add_argument("--convergence", action="store_true", help="errors under refinement instead of speed")
    what.add_argument("--effects", action="store_true", help="only what every effect of the catalogue costs")
    what.add_argument(
        "--swimming",
        action="store_true",
        help="only a free swim, and a sweep of 57 swims of 10 s in two processes",
    )
    what.add_argument(
        "--against",
        type=Path,
        metavar="CLONE",
        help="only how much less time a run takes than in another revision",
    )
    options.add_argument("--json", type=Path, metavar="FILE", help="write all numbers here")
    return options


def effects_parser() -> argparse.ArgumentParser:
    """Options of `effects`."""
    options = argparse.ArgumentParser(
        prog="effects", description="List the physical effects that a model can have, or print one's card."
    )
    options.add_argument(
        "names", nargs="*", metavar="NAME", help="an effect's id, or path/to/file.py:ClassName of your own"
    )
    options.add_argument("--table", action="store_true", help="print all of them as the documentation's page")
    return options


def show_mesh_parser() -> argparse.ArgumentParser:
    """Options of `show_mesh`."""
    options = argparse.ArgumentParser(
        prog="show_mesh", description="Draw a model's body, its regions and markers to a picture."
    )
    options.add_argument(
        "model", nargs="?", default="swimmer", help="name or file of a model (default: swimmer)"
    )
    options.add_argument(
        "--output", type=Path, metavar="FILE", help="PNG, SVG or PDF (default: MODEL_mesh.png)"
    )
    options.add_argument("--density", type=float, metavar="D", help="mesh density, instead of the model's")
    options.add_argument(
        "--bent",
        type=float,
        metavar="LEVEL",
        help="bent by its first drive, held at this level: the markers and the angle between them",
    )
    return options


def _of_swimmer(options: argparse.ArgumentParser) -> None:
    """What every command about a free swimmer takes."""
    options.add_argument(
        "--model", default="swimmer_in_oil", metavar="NAME|FILE", help="default: swimmer_in_oil"
    )
    options.add_argument(
        "--set",
        type=assignment,
        action="append",
        default=[],
        metavar="PARAMETER=VALUE",
        help="another value of a parameter or of a constant of the model",
    )


def swim_parser() -> argparse.ArgumentParser:
    """Options of `swim`."""
    options = argparse.ArgumentParser(
        prog="swim",
        description="How fast a free body swims, by voltage and frequency: a table, a picture and the optimum.",
    )
    _of_swimmer(options)
    options.add_argument(
        "--voltage",
        type=voltages,
        default=((3500.0, 3500.0), (4500.0, 4500.0), (5500.0, 5500.0)),
        metavar="V,V,…",
        help="of the boxes, in V; 5500/4800 for unequal muscles (default: 3500,4500,5500)",
    )
    options.add_argument(
        "--frequency",
        type=numbers,
        default=numbers("1:10:0.5"),
        metavar="A:B:STEP",
        help="in Hz, a range or a list with commas (default: 1:10:0.5)",
    )
    options.add_argument(
        "--duration", type=positive, default=10.0, metavar="S", help="of each swim, in s (default: 10)"
    )
    options.add_argument(
        "--free",
        type=free_range,
        action="append",
        default=[],
        metavar="PARAMETER=LOW:HIGH[:COUNT]",
        help="repeat the sweep with a parameter or constant at values of a range (3 of them): what decides the optimum",
    )
    options.add_argument(
        "--output",
        type=Path,
        default=Path("swim"),
        metavar="DIR",
        help="for table and picture (default: swim)",
    )
    options.add_argument("--json", type=Path, metavar="FILE", help="write all numbers here")
    options.add_argument("--jobs", type=int, metavar="N", help="processes (default: one per core)")
    options.add_argument(
        "--scheduler", metavar="ADDRESS", help="a Dask cluster, such as tcp://head-node:8786"
    )
    return options


def optimise_parser() -> argparse.ArgumentParser:
    """Options of `optimise`."""
    options = argparse.ArgumentParser(
        prog="optimise",
        description="Find with which waveform of its two muscles, or with which outline and fin, a free body swims "
        "best. A waveform is written as a file that an experiment can play, a body as a model file.",
    )
    _of_swimmer(options)
    options.add_argument("--frequency", type=positive, default=2.0, metavar="HZ", help="default: 2")
    options.add_argument(
        "--goal",
        choices=("speed", "cost"),
        default="speed",
        help="the fastest swim, or the least work per mass and distance (default: speed)",
    )
    options.add_argument(
        "--turning",
        type=float,
        metavar="DEG_PER_S",
        help="the rate at which it is to turn to the left: 0 swims straight (default: whatever comes)",
    )
    options.add_argument(
        "--heading",
        type=float,
        metavar="DEG",
        help="where it is to point at the end of --duration, to the left of its start (default: wherever it comes to)",
    )
    options.add_argument(
        "--vary",
        type=varied,
        default=varied("first,second"),
        metavar="NAME[=LOW:HIGH],…",
        help="what may change: first and second (the voltages), duty, phase, outline, and constants of the model file "
        "by their path, such as body.spine.fin_length_m=0.02:0.06, between half and double without a range (default: "
        "first,second)",
    )
    options.add_argument(
        "--start",
        type=voltages,
        default=((5000.0, 5000.0),),
        metavar="V[/V]",
        help="voltages to start from (default: 5000)",
    )
    options.add_argument("--duty", type=positive, default=1.0, help="to start from (default: 1)")
    options.add_argument("--phase", type=positive, default=0.5, help="to start from (default: 0.5)")
    options.add_argument(
        "--largest", type=positive, default=5500.0, metavar="V", help="largest voltage (default: 5500)"
    )
    options.add_argument(
        "--duration", type=positive, default=4.0, metavar="S", help="of the swims that are tried (default: 4)"
    )
    options.add_argument(
        "--density",
        type=positive,
        default=0.5,
        metavar="D",
        help="mesh density while searching (default: 0.5)",
    )
    options.add_argument("--most", type=int, default=20, metavar="N", help="iterations at most (default: 20)")
    options.add_argument(
        "--play", type=positive, default=20.0, metavar="S", help="length of the waveform file (default: 20)"
    )
    options.add_argument(
        "--output",
        type=Path,
        default=Path("best_waveform.csv"),
        metavar="FILE",
        help="the waveform (default: best_waveform.csv)",
    )
    options.add_argument(
        "--body",
        type=Path,
        default=Path("best_body.yaml"),
        metavar="FILE",
        help="the model file, where something of the body varies (default: best_body.yaml)",
    )
    options.add_argument("--json", type=Path, metavar="FILE", help="write all numbers here")
    return options


def _executable(module: str, parser: Callable[[], argparse.ArgumentParser]) -> Callable[..., int]:
    """The command whose `run` is in this module; it takes the arguments of a shell, or a list of them."""

    def main(arguments: Sequence[str] | None = None) -> int:
        options = parser().parse_args(arguments)
        return import_module(f"hasel_sim.{module}").run(options)

    return command(main)


bench = _executable("commands.bench", bench_parser)
effects = _executable("commands.effects", effects_parser)
optimise = _executable("commands.optimise", optimise_parser)
show_mesh = _executable("mesh_picture", show_mesh_parser)
swim = _executable("commands.swim", swim_parser)
