"""Parameters of the lifecycle manager."""

from hasel_common.node_parameter import NodeParameter

PARAMETERS = (
    NodeParameter(
        "nodes",
        ["hasel_driver", "hasel_tracker", "hasel_simulator", "hasel_sysid", "hasel_recorder"],
        "in the order in which they go up, and down; the first is the driver, or whoever can be live",
    ),
    NodeParameter("autostart", True, "bring them up at the start; false: wait for lifecycle_manager/startup"),
    NodeParameter("answer_time", 10.0, "after which a node without an answer has ended", "s", 0.5, 60.0),
)
