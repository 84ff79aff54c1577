"""`ros2 run hasel_driver console`: where the executable begins; --help is answered before anything is imported."""

import sys

from hasel_common.command_entry import command
from hasel_common.node_parameter import user_arguments

from hasel_driver.console_options import parser


@command
def main() -> int:
    """Run the console until it is left; returns the exit code."""
    options = parser().parse_args(user_arguments(sys.argv[1:]))
    from hasel_driver.console import run

    return run(options.namespace)


if __name__ == "__main__":
    sys.exit(main())
