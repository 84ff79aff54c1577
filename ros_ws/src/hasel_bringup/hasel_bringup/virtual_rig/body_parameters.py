"""Parameters of the virtual body."""

from hasel_common.node_parameter import NodeParameter

from hasel_bringup.hidden_truth.hidden import MEANING, NOTHING

PARAMETERS = (
    NodeParameter("model", "swimmer", "model of the truth: its name or file"),
    NodeParameter("hidden", [NOTHING], MEANING),
    NodeParameter("white_noise", 0.002, "noise of each frame by itself, rms of sin theta", "1", 0.0, 1.0),
    NodeParameter(
        "coloured_noise", 0.002, "noise shared by neighbouring frames, rms of sin theta", "1", 0.0, 1.0
    ),
    NodeParameter("correlation", 0.9, "of the coloured noise from frame to frame", "1", 0.0, 0.999),
    NodeParameter("offset", 0.0, "what the camera reads on a straight body, as sin theta", "1", -1.0, 1.0),
    NodeParameter("seed", 1, "of the noise and of what is hidden at random", "1", 0, 2**31 - 1),
    NodeParameter("frame_rate", 120.0, "of the camera, which has a clock of its own", "1/s", 1.0, 1000.0),
)
