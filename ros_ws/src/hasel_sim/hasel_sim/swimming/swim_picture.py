"""Speed against frequency, a curve per voltage: the seed paper's figure."""

from collections.abc import Mapping, Sequence

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib.figure import Figure

from hasel_sim.swimming.optimum import Optimum
from hasel_sim.swimming.sweep import Swam

COLOURS = ("#4b86b4", "#d9654b", "#3f8f6b", "#8a5fa8", "#c9a227", "#44505c")
MARKS = "osD^vP"


def draw_speeds(
    title: str, curves: Mapping[str, Sequence[Swam]], optima: Mapping[str, Optimum | None]
) -> Figure:
    """Speed [mm/s] over frequency [Hz], with each curve's optimum and its interval."""
    figure = Figure(figsize=(7.5, 4.5), layout="constrained")
    axes = figure.add_subplot()
    for number, (label, swam) in enumerate(curves.items()):
        colour, mark = COLOURS[number % len(COLOURS)], MARKS[number % len(MARKS)]
        ordered = sorted(swam, key=lambda one: one.frequency_hz)
        f = np.array([one.frequency_hz for one in ordered])
        u = 1e3 * np.array([one.speed_m_per_s for one in ordered])
        axes.plot(f, u, mark, color=colour, linestyle="-", markersize=5, label=label)
        top = optima.get(label)
        if top is not None and not top.at_edge:
            axes.plot(
                top.frequency, 1e3 * top.speed, "*", color=colour, markeredgecolor="black", markersize=13
            )
            if top.interval:
                axes.axvspan(*top.interval, color=colour, alpha=0.12, linewidth=0)
    axes.axhline(0.0, color="#888888", linewidth=0.7)
    axes.set_xlabel("frequency of the boxes [Hz]")
    axes.set_ylabel("swimming speed [mm/s]")
    axes.set_title(title)
    axes.legend(frameon=False)
    axes.grid(color="#dddddd", linewidth=0.5)
    return figure
