"""`ros2 run hasel_driver driver_node`: where the executable begins; --help is answered before a port is opened."""

import signal
import sys

from hasel_common.command_entry import command
from hasel_common.node_parameter import answer_help

from hasel_driver.parameters import PARAMETERS


@command
def main() -> int:
    """Run the node until it is shut down; returns the exit code."""
    answer_help(
        "driver_node",
        "Drives the high-voltage supply at a serial port: opens the port when it starts, arms nothing by itself.",
        [each.usage for each in PARAMETERS],
    )
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(
            number, signal.SIG_DFL
        )  # until the node takes them over, nothing is open that must be grounded
    from hasel_driver.driver_node import main as run

    return run()


if __name__ == "__main__":
    sys.exit(main())
