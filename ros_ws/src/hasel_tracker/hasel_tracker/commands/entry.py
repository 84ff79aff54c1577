"""Where the executables begin: options are read before anything heavy is imported, so that --help answers at once."""

from hasel_common.command_entry import command

from hasel_tracker.commands import parsers


@command
def calibrate() -> int:
    """`calibrate colour|body|board|distance`."""
    options = parsers.calibrate_parser().parse_args()
    from hasel_tracker.commands.calibrate import run

    return run(options)


@command
def track() -> int:
    """`track VIDEO`."""
    options = parsers.track_parser().parse_args()
    from hasel_tracker.commands.track import run

    return run(options)
