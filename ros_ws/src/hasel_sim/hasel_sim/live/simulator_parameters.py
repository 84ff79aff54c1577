# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The simulator node's parameters, without anything that takes time to import."""

from hasel_common.node_parameter import AUTOSTART, NodeParameter

PARAMETERS = (
    NodeParameter(*AUTOSTART),
    NodeParameter("model", "swimmer", "model simulated at the start: its name or file"),
    NodeParameter(
        "effects", [""], "effects added to the model at the start: ids, or path/to/file.py:ClassName"
    ),
    NodeParameter(
        "own_files", "", "folder below which add_effect and load_model may read files of yours; empty: none"
    ),
    NodeParameter(
        "rate",
        0.0,
        "most angles published per second; 0: one for every state",
        "1/s",
        0.0,
        1000.0,
        changeable=True,
    ),
    NodeParameter(
        "shape_rate",
        20.0,
        "shapes published per second, if anybody listens",
        "1/s",
        0.0,
        20.0,
        changeable=True,
    ),
    NodeParameter("history", 20.0, "how far back drive and observation effects remember", "s", 1.0, 600.0),
    NodeParameter("gap", 0.1, "state messages further apart are reported as missing", "s", 0.001, 10.0),
    NodeParameter("reset", 2.0, "a longer gap starts a new run from rest", "s", 0.01, 3600.0),
    NodeParameter(
        "late",
        0.5,
        "an older message is ignored; if older by more than this, starts a new run",
        "s",
        0.0,
        60.0,
    ),
    NodeParameter(
        "load_factor", 1.0, "a run starts in equilibrium under this many times all loads", "1", 0.0, 10.0
    ),
    NodeParameter("frame_id", "swimmer", "frame of the stamped messages, within the node's namespace"),
)
