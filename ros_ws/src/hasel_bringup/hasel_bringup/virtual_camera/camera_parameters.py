"""Parameters of the virtual camera."""

from hasel_common.node_parameter import NodeParameter

from hasel_bringup.hidden_truth.hidden import MEANING, RANDOM

PARAMETERS = (
    NodeParameter("hidden", [RANDOM], MEANING),
    NodeParameter("seed", -1, "of secret, muscles and noise; -1: another one each time", "1", -1, 2**31 - 1),
    NodeParameter("frame_rate", 120.0, "of the camera, which has a clock of its own", "1/s", 1.0, 1000.0),
    NodeParameter("width", 640, "of the picture", "px", 64, 4096),
    NodeParameter("height", 320, "of the picture", "px", 64, 4096),
    NodeParameter("scale", 2000.0, "of the picture", "px/m", 500.0, 50e3),
    NodeParameter("noise", 2.0, "of the sensor, standard deviation in grey levels", "1", 0.0, 50.0),
    NodeParameter(
        "ripple", 1e-4, "how far the water's surface displaces a marker's picture, rms", "m", 0.0, 0.005
    ),
    NodeParameter(
        "real_time",
        "auto",
        "send pictures as they are exposed (yes), after each run (no), or what the machine can",
    ),
)
