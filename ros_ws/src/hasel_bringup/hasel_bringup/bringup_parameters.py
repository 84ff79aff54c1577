# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Parameters of the nodes."""

from hasel_common.node_parameter import AUTOSTART, NodeParameter

from hasel_bringup.hidden_truth.hidden import MEANING, NOTHING, RANDOM

_FRAME_RATE = NodeParameter(
    "frame_rate", 120.0, "of the camera, which has a clock of its own", "1/s", 1.0, 1000.0
)
LIFECYCLE_MANAGER = (
    NodeParameter(
        "nodes",
        ["hasel_driver", "hasel_tracker", "hasel_simulator", "hasel_sysid", "hasel_recorder"],
        "in the order in which they go up, and down; the first is the driver, or whoever can be live",
    ),
    NodeParameter("autostart", True, "bring them up at the start; false: wait for lifecycle_manager/startup"),
    NodeParameter("answer_time", 10.0, "after which a node without an answer has ended", "s", 0.5, 60.0),
)
RECORDER = (
    NodeParameter("folder", "recordings", "into which recordings are written, and nowhere else"),
    NodeParameter("name", "run", "of the next recording, without folder and .mcap", changeable=True),
    NodeParameter(*AUTOSTART),
)
VIRTUAL_CAMERA = (
    NodeParameter("hidden", [RANDOM], MEANING),
    NodeParameter("seed", -1, "of secret, muscles and noise; -1: another one each time", "1", -1, 2**31 - 1),
    _FRAME_RATE,
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
VIRTUAL_BODY = (
    NodeParameter("model", "swimmer", "model of the truth: its name or file"),
    NodeParameter("hidden", [NOTHING], MEANING),
    NodeParameter("white_noise", 0.002, "noise of each frame by itself, rms of sin theta", "1", 0.0, 1.0),
    NodeParameter(
        "coloured_noise", 0.002, "noise shared by neighbouring frames, rms of sin theta", "1", 0.0, 1.0
    ),
    NodeParameter("correlation", 0.9, "of the coloured noise from frame to frame", "1", 0.0, 0.999),
    NodeParameter("offset", 0.0, "what the camera reads on a straight body, as sin theta", "1", -1.0, 1.0),
    NodeParameter("seed", 1, "of the noise and of what is hidden at random", "1", 0, 2**31 - 1),
    _FRAME_RATE,
)
