"""Where the executable begins: options are read before anything heavy is imported, so that --help answers at once."""

from hasel_common.command_entry import command
from hasel_sysid.command_line.options import run_module

from hasel_workbench.options import workbench_parser


@command
def workbench() -> int:
    """`workbench [RECORDING…]`."""
    return run_module(workbench_parser, "hasel_workbench.command")
