# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_sysid sysid`: --help is answered before all that is slow."""

import sys

from hasel_common.command_entry import command
from hasel_common.node_parameter import answer_help

from hasel_sysid.live.sysid_parameters import PARAMETERS


@command
def main() -> None:
    """Run the node until it is interrupted; the process ends with its exit code."""
    answer_help(
        "sysid",
        "Publishes how far the simulated angle is from the measured one (/hasel/error), and fits and diagnoses what "
        "was heard when asked to (/hasel/fit, /hasel/diagnose).",
        [parameter.usage for parameter in PARAMETERS],
    )
    from hasel_sysid.live.sysid_node import main as run

    run()


if __name__ == "__main__":
    sys.exit(main())
