# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Measured against simulated angle of one run, and below it what each model leaves."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from hasel_sysid.report.content import RunOverlay
from hasel_sysid.report.style import CHANNELS, MEASURED, base_layout, model_colour, plain_axis

_HEIGHT, _MOST_POINTS, _MOST_SHADES = 330, 400, 60
_DEGREES = (1, 2, 5, 10, 15, 30)
"""Steps of the angle's axis."""


def decimate(time: np.ndarray, series: np.ndarray, most: int = 600) -> tuple[np.ndarray, np.ndarray]:
    """At most `most` points of a series [n] at times [s] [n]: first, last, and the extremes of stretches between."""
    if len(time) <= most:
        return time, series
    edges = np.linspace(0, len(time), max(1, (most - 2) // 2) + 1).astype(int)
    kept = {0, len(time) - 1}
    for begin, end in zip(edges[:-1], edges[1:], strict=True):
        part = series[begin:end]
        if np.isfinite(part).any():
            kept |= {begin + int(np.nanargmin(part)), begin + int(np.nanargmax(part))}
    index = np.array(sorted(kept))
    return time[index], series[index]


def overlay_figure(run: RunOverlay) -> dict[str, Any]:
    """sin θ with θ beside it, dots measured and lines simulated; below, measured minus simulated before and after.

    There is one for every run, so it is written as plotly.js takes it: plotly's own checks cost a second for twelve.
    """
    time, measured = _points(run.time, run.measured)
    dots = {"color": MEASURED, "size": 5, "opacity": 0.45}
    traces = [_trace(time, measured, "measured", "y", mode="markers", marker=dots, meta="measured")]
    labels = list(run.simulated)
    for number, label in enumerate(labels):
        last = number == len(labels) - 1
        line = {"color": model_colour(number, len(labels)), "width": 1.4 if last else 1.1}
        line |= {} if last else {"dash": "dot"}
        for axis, series in (("y", run.simulated[label]), ("y3", run.measured - run.simulated[label])):
            traces.append(_trace(*_points(run.time, series), label, axis, mode="lines", line=line))
    span, ticks = _angle_axis(run)
    # an axis without a trace is not drawn
    traces.append(_trace(time[:1], span[:1], "", "y2", mode="markers", opacity=0, hoverinfo="skip"))
    layout = {
        **base_layout(_HEIGHT),
        "showlegend": False,
        "margin": {"l": 58, "r": 46, "t": 8, "b": 38},
        "xaxis": plain_axis(
            anchor="y3", title={"text": "time [s]", "standoff": 4}, ticks="outside", ticklen=4
        ),
        "yaxis": plain_axis(domain=[0.4, 1.0], range=span, title={"text": "sin θ", "standoff": 4}),
        "yaxis2": plain_axis(
            overlaying="y",
            side="right",
            range=span,
            showgrid=False,
            tickvals=[float(np.sin(np.deg2rad(tick))) for tick in ticks],
            ticktext=[f"{tick}°" for tick in ticks],
            title={"text": "θ", "standoff": 2},
        ),
        "yaxis3": plain_axis(domain=[0.0, 0.34], title={"text": "residual", "standoff": 4}),
        "shapes": _shades(run),
    }
    return {"data": traces, "layout": layout}


def _trace(time: list[float], series: list[float], name: str, axis: str, **more: Any) -> dict[str, Any]:
    return {"type": "scatter", "x": time, "y": series, "name": name, "xaxis": "x", "yaxis": axis, **more}


def model_colours(run: RunOverlay) -> list[tuple[str, str, bool]]:
    """Every model's label and colour, and whether its line is dotted, for a legend above all runs."""
    labels = list(run.simulated)
    return [
        (label, model_colour(number, len(labels)), number < len(labels) - 1)
        for number, label in enumerate(labels)
    ]


def _points(time: np.ndarray, series: np.ndarray) -> tuple[list[float], list[float]]:
    time, series = decimate(time, series, _MOST_POINTS)
    return np.round(time, 4).tolist(), np.round(series, 5).tolist()


def _angle_axis(run: RunOverlay) -> tuple[list[float], list[int]]:
    """Range of sin θ, and the whole angles [deg] that are marked within it."""
    shown = np.concatenate([run.measured, *run.simulated.values()])
    low, high = float(np.nanmin(shown)), float(np.nanmax(shown))
    margin = 0.06 * (high - low) or 0.01
    widest = np.rad2deg(np.arcsin(min(1.0, max(abs(low), abs(high)))))
    step = next((each for each in _DEGREES if widest / each <= 3.5), _DEGREES[-1])
    ticks = [n * step for n in range(-90 // step, 90 // step + 1)]
    span = [low - margin, high + margin]
    return span, [tick for tick in ticks if span[0] <= np.sin(np.deg2rad(tick)) <= span[1]]


def _shades(run: RunOverlay) -> list[dict[str, Any]]:
    """A tint behind both plots while a channel is driven."""
    return [
        {
            "type": "rect",
            "xref": "x",
            "yref": "paper",
            "x0": begin,
            "x1": end,
            "y0": 0,
            "y1": 1,
            "fillcolor": CHANNELS[channel % len(CHANNELS)],
            "opacity": 0.13,
            "line": {"width": 0},
            "layer": "below",
        }
        for begin, end, channel in run.driven[:_MOST_SHADES]
    ]


def driven_stretches(
    time: np.ndarray, values: np.ndarray, begin: float, end: float
) -> Sequence[tuple[float, float, int]]:
    """Begin [s], end [s] and channel of the stretches in which a channel has more than half of its largest value.

    time [s] [n], values [n, channels], each holding until the next.
    """
    found = []
    for channel, series in enumerate(np.abs(values).T):
        on = series > 0.5 * series.max(initial=0.0)
        switched = np.flatnonzero(np.diff(np.concatenate([[False], on, [False]]).astype(int)))
        edges = np.append(time, max(end, time[-1]))[switched].reshape(-1, 2)
        found += [(max(b, begin), min(e, end), channel) for b, e in edges.tolist() if b < end and e > begin]
    return sorted(found)
