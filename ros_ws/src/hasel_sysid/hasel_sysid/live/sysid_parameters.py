# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The identification node's parameters, without anything that takes time to import."""

from hasel_common.node_parameter import AUTOSTART, NodeParameter

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
