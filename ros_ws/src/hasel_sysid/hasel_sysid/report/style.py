# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One look for all figures."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MEASURED = "#30363d"
MODELS = ("#d1495b", "#2e86ab", "#edae49", "#66a182", "#8d6a9f", "#5c6b73")
FITTED, UNSEEN, NOISE = "#2e86ab", "#edae49", "#8a949e"
OF_RUNS = {"fitted runs": FITTED, "unseen runs": UNSEEN}
DROP, RISE = "#8fc3a3", "#d1495b"
CHANNELS = ("#2e86ab", "#e08e0b", "#66a182", "#8d6a9f")
"""Tints of the drive's channels, in their order."""
GRID = "#e6e9ec"
AXIS = {"gridcolor": GRID, "zerolinecolor": GRID, "linecolor": "#c3c9cf"}
FONT = "Inter, system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"


def model_colour(number: int, count: int) -> str:
    """Of one of several models; the last one's is the strong one."""
    return MODELS[0] if number == count - 1 else MODELS[1 + number % (len(MODELS) - 1)]


def base_layout(height: int) -> dict[str, Any]:
    """Fonts, colours and margins of every figure; height in pixels."""
    return {
        "height": height,
        "autosize": True,
        "font": {"family": FONT, "size": 13, "color": "#24292f"},
        "paper_bgcolor": "rgba(0,0,0,0)",
        "plot_bgcolor": "rgba(0,0,0,0)",
        "margin": {"l": 60, "r": 20, "t": 44, "b": 48},
        "hoverlabel": {"font": {"family": FONT}},
        "legend": {"orientation": "h", "y": 1.0, "yanchor": "top", "x": 0.05, "yref": "container"},
    }


def plain_axis(**more: Any) -> dict[str, Any]:
    """An axis of a figure that is written as plain dictionaries."""
    return {**AXIS, **more}


def bare(axis: "Axes") -> None:
    """Of matplotlib: without the lines above and beside it, small numbers."""
    axis.spines[["top", "right"]].set_visible(False)
    axis.tick_params(labelsize=8)
