"""`ros2 run hasel_sysid sysid`: its parameters, and where the executable begins: --help is answered first."""

import sys

from hasel_common.command_entry import command
from hasel_common.node_parameter import AUTOSTART, NodeParameter, answer_help

PARAMETERS = (
    NodeParameter(*AUTOSTART),
    NodeParameter("model", "swimmer", "model that is fitted: its name or file"),
    NodeParameter("effects", [""], "effects added to it: ids, or path/to/file.py:ClassName"),
    NodeParameter(
        "own_files", "", "folder below which diagnose may read files of effects of yours; empty: none"
    ),
    NodeParameter("output", ".", "folder into which fitted models are written"),
    NodeParameter("jobs", 0, "processes that simulate; 0: one per core", "1", 0, 256, changeable=True),
    NodeParameter("gap", 0.1, "no interpolation between simulated angles further apart", "s", 0.001, 10.0),
    NodeParameter("reset", 2.0, "a longer gap begins a new run", "s", 0.01, 3600.0),
    NodeParameter("window", 5.0, "length of the sliding window of /hasel/error", "s", 0.1, 3600.0),
    NodeParameter("late", 0.5, "stamps that go back by more begin a new run", "s", 0.0, 60.0),
    NodeParameter("frame_id", "swimmer", "frame of the stamped messages, within the node's namespace"),
)


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
