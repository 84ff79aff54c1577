"""Where the executable begins: options are read before anything heavy is imported, so that --help answers at once."""

from hasel_common.command_entry import command
from hasel_sysid.command_line.options import run_module

from hasel_muscle.options import bench_muscle_parser


@command
def bench_muscle() -> int:
    """`bench_muscle RECORDING…`."""
    return run_module(bench_muscle_parser, "hasel_muscle.command")
