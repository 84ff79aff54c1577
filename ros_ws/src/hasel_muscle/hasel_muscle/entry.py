"""Where the executable begins: options are read before anything heavy is imported, so that --help answers at once."""

from importlib import import_module

from hasel_common.command_entry import command

from hasel_muscle.options import bench_muscle_parser


@command
def bench_muscle() -> int:
    """`bench_muscle RECORDING…`."""
    options = bench_muscle_parser().parse_args()
    return import_module("hasel_muscle.command").run(options)
