"""Where the executable begins: options are read before anything heavy is imported, so that --help answers at once."""

from importlib import import_module

from hasel_common.command_entry import command

from hasel_workbench.options import workbench_parser


@command
def workbench() -> int:
    """`workbench [RECORDING…]`."""
    options = workbench_parser().parse_args()
    return import_module("hasel_workbench.command").run(options)
