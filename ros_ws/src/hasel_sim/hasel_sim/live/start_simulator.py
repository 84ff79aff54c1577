# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_sim simulator`: --help is answered before all that is slow."""

import sys

from hasel_common.command_entry import command
from hasel_common.node_parameter import answer_help

from hasel_sim.live.simulator_parameters import PARAMETERS


@command
def main() -> int:
    """Run the node until it is interrupted; returns the exit code."""
    answer_help(
        "simulator",
        "Simulates the bending angle under the supply's state (/hasel/state), and publishes it "
        "(/hasel/bending/simulated) with the shape (/hasel/swimmer).",
        [parameter.usage for parameter in PARAMETERS],
    )
    from hasel_sim.live.simulator_node import main as run

    return run()


if __name__ == "__main__":
    sys.exit(main())
