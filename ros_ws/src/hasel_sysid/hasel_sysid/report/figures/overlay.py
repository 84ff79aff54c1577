"""Measured against simulated angle of one run, and below it what each model leaves."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from hasel_sysid.report.content import RunOverlay
from hasel_sysid.report.decimate import decimate
from hasel_sysid.report.figures.style import CHANNELS, MEASURED, model_colour, styled

_HEIGHT, _MOST_POINTS, _MOST_SHADES = 330, 400, 60
_DEGREES = (1, 2, 5, 10, 15, 30)
"""Steps of the angle's axis."""


def overlay_figure(run: RunOverlay) -> go.Figure:
    """sin θ with θ beside it, dots measured and lines simulated; below, measured minus simulated before and after."""
    figure = make_subplots(
        rows=2,
        cols=1,
        shared_xaxes=True,
        row_heights=[0.64, 0.36],
        vertical_spacing=0.05,
        specs=[[{"secondary_y": True}], [{}]],
    )
    labels = list(run.simulated)
    time, measured = _points(run.time, run.measured)
    dots = {"color": MEASURED, "size": 5, "opacity": 0.45}
    figure.add_trace(
        go.Scatter(x=time, y=measured, name="measured", meta="measured", mode="markers", marker=dots),
        row=1,
        col=1,
    )
    for number, label in enumerate(labels):
        last = number == len(labels) - 1
        line = {"color": model_colour(number, len(labels)), "width": 1.4 if last else 1.1}
        for row, series in ((1, run.simulated[label]), (2, run.measured - run.simulated[label])):
            x, y = _points(run.time, series)
            trace = go.Scatter(
                x=x,
                y=y,
                name=label,
                legendgroup=label,
                showlegend=row == 1,
                mode="lines",
                line=line if last else {**line, "dash": "dot"},
            )
            figure.add_trace(trace, row=row, col=1)
    _add_degrees(figure, run)
    _shade(figure, run)
    figure.update_xaxes(title_text="time [s]", title_standoff=4, row=2)
    figure.update_yaxes(title_text="sin θ", title_standoff=4, row=1, col=1, secondary_y=False)
    figure.update_yaxes(title_text="residual", title_standoff=4, row=2, col=1)
    styled(figure, _HEIGHT)
    return figure.update_layout(showlegend=False, margin={"l": 58, "r": 46, "t": 8, "b": 38})


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


def _add_degrees(figure: go.Figure, run: RunOverlay) -> None:
    """The angle itself on the right, at the same heights as its sine."""
    shown = np.concatenate([run.measured, *run.simulated.values()])
    low, high = float(np.nanmin(shown)), float(np.nanmax(shown))
    margin = 0.06 * (high - low) or 0.01
    span = [low - margin, high + margin]
    widest = np.rad2deg(np.arcsin(min(1.0, max(abs(low), abs(high)))))
    step = next((each for each in _DEGREES if widest / each <= 3.5), _DEGREES[-1])
    ticks = [n * step for n in range(-90 // step, 90 // step + 1)]
    ticks = [tick for tick in ticks if span[0] <= np.sin(np.deg2rad(tick)) <= span[1]]
    figure.add_trace(
        go.Scatter(x=[run.time[0]], y=[low], mode="markers", opacity=0, hoverinfo="skip", showlegend=False),
        row=1,
        col=1,
        secondary_y=True,
    )
    figure.update_yaxes(range=span, row=1, col=1)
    figure.update_yaxes(
        tickvals=[float(np.sin(np.deg2rad(tick))) for tick in ticks],
        ticktext=[f"{tick}°" for tick in ticks],
        title_text="θ",
        title_standoff=2,
        showgrid=False,
        row=1,
        col=1,
        secondary_y=True,
    )


def _shade(figure: go.Figure, run: RunOverlay) -> None:
    """A tint behind both plots while a channel is driven."""
    for (begin, end, channel), _ in zip(run.driven, range(_MOST_SHADES), strict=False):
        figure.add_vrect(
            x0=begin,
            x1=end,
            fillcolor=CHANNELS[channel % len(CHANNELS)],
            opacity=0.13,
            line_width=0,
            layer="below",
        )


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
