"""Parameters of the recorder."""

from hasel_common.node_parameter import AUTOSTART, NodeParameter

PARAMETERS = (
    NodeParameter("folder", "recordings", "into which recordings are written, and nowhere else"),
    NodeParameter("name", "run", "of the next recording, without folder and .mcap", changeable=True),
    NodeParameter(*AUTOSTART),
)
