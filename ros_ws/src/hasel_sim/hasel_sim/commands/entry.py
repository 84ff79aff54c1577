"""Where the executables begin: options are read before anything heavy is imported, so that --help answers at once."""

from hasel_common.command_entry import command

from hasel_sim.commands import parsers


@command
def bench() -> int:
    """`bench`."""
    options = parsers.bench_parser().parse_args()
    from hasel_sim.commands.bench import run

    return run(options)


@command
def effects() -> int:
    """`effects [NAME…]`."""
    options = parsers.effects_parser().parse_args()
    from hasel_sim.commands.effects import run

    return run(options)


@command
def optimise() -> int:
    """`optimise`."""
    options = parsers.optimise_parser().parse_args()
    from hasel_sim.commands.optimise import run

    return run(options)


@command
def show_mesh() -> int:
    """`show_mesh [MODEL]`."""
    options = parsers.show_mesh_parser().parse_args()
    from hasel_sim.commands.show_mesh import run

    return run(options)


@command
def swim() -> int:
    """`swim`."""
    options = parsers.swim_parser().parse_args()
    from hasel_sim.commands.swim import run

    return run(options)
