"""Where the executables begin: options are read before anything heavy is imported, so that --help answers at once."""

import sys
from importlib import import_module

from hasel_common.command_entry import command
from hasel_common.node_parameter import user_arguments


@command
def bench_cluster() -> int:
    """`bench_cluster`: how much sooner do two workers answer than one?"""
    return _run("bench_cluster")


@command
def bench_far() -> int:
    """`bench_far`: is a constant that is far off named?"""
    return _run("bench_far")


@command
def bench_fits() -> int:
    """`bench_fits`: does a fit reach the likelihood of the truth?"""
    return _run("bench_fits")


@command
def bench_hidden() -> int:
    """`bench_hidden`: how often is the right hidden effect named?"""
    return _run("bench_hidden")


@command
def bench_recordings() -> int:
    """`bench_recordings`: what do more recordings cost?"""
    return _run("bench_recordings")


def _run(command: str) -> int:
    options = (
        import_module(f"hasel_benchmark.{command}.options").parser().parse_args(user_arguments(sys.argv[1:]))
    )
    return import_module(f"hasel_benchmark.{command}.command").run(options)
