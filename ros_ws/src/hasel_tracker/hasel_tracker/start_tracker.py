"""`ros2 run hasel_tracker tracker_node`: where the executable begins; --help is answered before a camera is opened."""

import sys

from hasel_common.command_entry import command
from hasel_common.node_usage import answer_help

from hasel_tracker.node_parameters import PARAMETERS


@command
def main() -> int:
    """Run the node until it is interrupted; returns the exit code."""
    answer_help(
        "tracker_node",
        "Follows the markers of a camera or video and publishes the bending angle (/hasel/bending/measured).",
        [each.usage for each in PARAMETERS],
    )
    from hasel_tracker.tracker_node import main as run

    return run()


if __name__ == "__main__":
    sys.exit(main())
