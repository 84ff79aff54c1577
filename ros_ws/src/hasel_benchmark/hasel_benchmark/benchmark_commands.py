# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The benchmarks' commands: where they begin, their options, and what all of them do alike.

Options are read before anything heavy is imported, so that --help answers at once.
"""

import argparse
import json
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar

from hasel_common.command_entry import command, in_a_sentence
from hasel_common.node_parameter import user_arguments

from hasel_benchmark.errors import BenchmarkError

SIZES = {
    "payload": "payload.mass",
    "soft_modulus": "soft_modulus.scale",
    "added_mass": "added_mass.added_mass",
    "spine_modulus": "spine_modulus.scale",
}
"""The constants that `bench_far` sets wrong, by the effect that has them; how far, and of which bodies:"""
SHIFTS = (-0.6, -0.4, -0.25, -0.1, 0.1, 0.25, 0.4, 0.6)
BODIES = ("beam", "swimmer")
KINDS = {
    "nothing": "nothing",
    "single": "single",
    "strong": "strong",
    "pairs": "pair",
    "unlisted": "unlisted",
    "set-up": "set_up",
}
"""The kind of a case of `bench_hidden`, by what it is called on the command line."""
DISCRETISATIONS = ("near", "coarse", "converged")
PAGE = Path("docs/results/hidden_effects.md")
_RECORDINGS = Path("data") / "unseen_rig" / "quadratic_drag"
_JOBS = "simulations at once (default: one per core)"


@command
def bench_cluster(arguments: Sequence[str] | None = None) -> int:
    """`bench_cluster`: how much sooner do two workers answer than one?"""
    options = argparse.ArgumentParser(
        prog="bench_cluster",
        description="Start Dask workers on this machine and time `improve` and `swim` with --scheduler, two workers "
        "against one in turns; the answers must be those of one process without a cluster, to the last digit. Takes "
        "about ten minutes.",
    )
    meaning = "with fit_*.csv and val_*.csv (default: %(default)s)"
    options.add_argument("--recordings", type=Path, default=_RECORDINGS, metavar="DIR", help=meaning)
    meaning = "of each, the middle one counts (default: %(default)s)"
    options.add_argument("--rounds", type=int, default=3, metavar="N", help=meaning)
    return _run(options, "bench_cluster", arguments, kept="times")


@command
def bench_far(arguments: Sequence[str] | None = None) -> int:
    """`bench_far`: is a constant that is far off named?"""
    options = argparse.ArgumentParser(
        prog="bench_far",
        description="Set a gross constant of a truth so that it rings 10 to 60 % faster or slower, and look whether "
        "`improve` names it. Takes an hour or more.",
    )
    names, shifts = tuple(SIZES), "such as -0.4,0.25"
    options.add_argument("--effects", type=_list_of(str), default=names, metavar="A,B", help="hidden ones")
    options.add_argument("--shifts", type=_list_of(float), default=SHIFTS, metavar="S,T", help=shifts)
    options.add_argument("--body", choices=BODIES, help="only this body")
    options.add_argument("--candidates", type=_list_of(str), metavar="A,B", help="try only these effects")
    return _run(options, "bench_far", arguments, _JOBS, "outcomes")


@command
def bench_fits(arguments: Sequence[str] | None = None) -> int:
    """`bench_fits`: does a fit reach the likelihood of the truth?"""
    options = argparse.ArgumentParser(
        prog="bench_fits",
        description="Hide every effect that has a place or a time, at five sizes over its plausible range, and look "
        "whether `fit` with that effect ends as likely as the truth. Takes half an hour or more.",
    )
    options.add_argument("--effects", type=_list_of(str), metavar="A,B", help="only these effects")
    options.add_argument("--seed", type=int, default=0, metavar="N", help="default: %(default)s")
    return _run(options, "bench_fits", arguments, _JOBS, "outcomes")


@command
def bench_hidden(arguments: Sequence[str] | None = None) -> int:
    """`bench_hidden`: how often is the right hidden effect named?"""
    options = argparse.ArgumentParser(
        prog="bench_hidden",
        description="Hide effects in a simulated truth, let `improve` look for them, and count. Takes hours; "
        "stop with Ctrl-C and go on with --resume.",
    )
    options.add_argument(
        "--seeds", type=int, default=5, metavar="N", help="per effect (default: %(default)s)"
    )
    meaning = "with 5 or more, cases that no rule was made on (default: %(default)s)"
    options.add_argument("--first-seed", type=_seed, default=0, metavar="N", help=meaning)
    options.add_argument("--effects", default="", metavar="A,B", help="only cases that hide one of these")
    options.add_argument("--only", choices=list(KINDS), help="only cases of this kind")
    options.add_argument(
        "--truth", choices=DISCRETISATIONS, default="near", help="discretisation of the truth"
    )
    options.add_argument("--quick", action="store_true", help="five cases, some minutes")
    options.add_argument(
        "--resume", action="store_true", help="keep what the output folder and the page hold"
    )
    output = Path("output/bench_hidden")
    options.add_argument("--output", type=Path, default=output, metavar="DIR", help="default: %(default)s")
    options.add_argument("--page", type=Path, metavar="FILE", help=f"default: {PAGE}, in DIR for a part")
    meaning = (
        "compare with an earlier search on the same cases: its output folder, or the JSON beside its page"
    )
    options.add_argument("--against", type=Path, metavar="PATH", help=meaning)
    meaning = "one case after the other, each with all jobs, as `improve` has them"
    options.add_argument("--alone", action="store_true", help=meaning)
    options.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster, instead of processes")
    return _run(options, "bench_hidden.command", arguments, "cases at once (default: one per core)")


@command
def bench_recordings(arguments: Sequence[str] | None = None) -> int:
    """`bench_recordings`: what do more recordings cost?"""
    options = argparse.ArgumentParser(
        prog="bench_recordings",
        description="Time `improve` for more and more recordings of one truth with a hidden effect: by the clock, in "
        "processor time, and how much memory all its processes take at once. Takes about ten minutes.",
    )
    numbers, meaning = (10, 30, 100), "of recordings, up to 102 (default: 10 30 100)"
    options.add_argument("--numbers", type=int, nargs="+", default=numbers, metavar="N", help=meaning)
    return _run(options, "bench_recordings", arguments, "processes (default: one per core)", "figures")


def _run(
    options: argparse.ArgumentParser,
    module: str,
    arguments: Sequence[str] | None,
    jobs: str = "",
    kept: str = "",
) -> int:
    """Call a module's `run` with the options given; what cannot be run is one sentence, and exit code 1.

    jobs: the meaning of --jobs, where there is such an option; kept: what --json writes, where there is one.
    """
    if jobs:
        options.add_argument("--jobs", type=int, metavar="N", help=jobs)
    if kept:
        options.add_argument("--json", type=Path, metavar="FILE", help=f"write the {kept}")
    given = options.parse_args(user_arguments(sys.argv[1:] if arguments is None else arguments))
    from hasel_sim.errors import ModelError, SimulationError

    run = import_module(f"hasel_benchmark.{module}").run
    return in_a_sentence(lambda: run(given), (BenchmarkError, ModelError, SimulationError), 1)


def told(outcomes: Iterable[Any], file: Path | None, line: Callable[[Any], str] = str) -> list[Any]:
    """All outcomes, each told in a line as soon as it is there; kept as JSON where a file is given."""
    found = []
    for outcome in outcomes:
        found.append(outcome)
        print(line(outcome), flush=True)
    if file:
        file.write_text(json.dumps([asdict(outcome) for outcome in found], indent=1))
    return found


_Kind = TypeVar("_Kind")


def _list_of(kind: Callable[[str], _Kind]) -> Callable[[str], tuple[_Kind, ...]]:
    return lambda text: tuple(kind(part) for part in text.split(","))


def _seed(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"'{text}' is no seed; give a whole number, 0 or more")
    return int(text)
