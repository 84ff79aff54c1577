"""The body's outline where it is bent most, with simulated and measured markers, to scale."""

import numpy as np
import plotly.graph_objects as go

from hasel_sysid.report.figures.style import styled
from hasel_sysid.report.shape import Shapes

_COLOURS = ("#8a949e", "#2e86ab", "#d1495b")


def shapes_figure(shapes: Shapes) -> go.Figure:
    """Grey at first, then blue and red; rings are the simulated markers, dots the measured ones."""
    figure = go.Figure()
    for time, skin, markers, measured, colour in zip(
        shapes.time, shapes.skin, shapes.markers, shapes.measured, _COLOURS, strict=False
    ):
        gaps = np.full((len(skin), 1, 2), np.nan)
        x, y = (1e3 * np.concatenate([skin, gaps], axis=1)).reshape(-1, 2).T
        name = f"{time:.2f} s"
        figure.add_trace(_lines(x, y, colour, name, True))
        figure.add_trace(_dots(1e3 * markers, colour, f"simulated, {name}", "circle-open", 11))
        figure.add_trace(_dots(1e3 * measured, colour, f"measured, {name}", "circle", 6))
    figure.update_yaxes(title_text="y [mm]", scaleanchor="x", constrain="domain")
    figure.update_xaxes(title_text="x [mm]", constrain="domain")
    return styled(figure, 320)


def _rounded(series: np.ndarray) -> list[float | None]:
    return [None if np.isnan(value) else round(float(value), 2) for value in series]


def _lines(x: np.ndarray, y: np.ndarray, colour: str, name: str, shown: bool) -> go.Scatter:
    return go.Scatter(
        x=_rounded(x),
        y=_rounded(y),
        mode="lines",
        name=name,
        showlegend=shown,
        hoverinfo="name",
        line={"color": colour, "width": 1.3},
    )


def _dots(markers: np.ndarray, colour: str, name: str, symbol: str, size: int) -> go.Scatter:
    return go.Scatter(
        x=_rounded(markers[:, 0]),
        y=_rounded(markers[:, 1]),
        mode="markers",
        name=name,
        showlegend=False,
        marker={"color": colour, "size": size, "symbol": symbol},
    )
