"""The body's outline at some instants of a swing, to scale."""

import numpy as np
import plotly.graph_objects as go

from hasel_sysid.report.figures.style import styled
from hasel_sysid.report.shape import Shapes

_FIRST, _LAST = np.array([46, 134, 171]), np.array([209, 73, 91])


def shapes_figure(shapes: Shapes) -> go.Figure:
    """Blue at first, red at last; dots are the markers that give the angle."""
    figure = go.Figure()
    count = len(shapes.time)
    for number, (time, skin, markers) in enumerate(
        zip(shapes.time, shapes.skin, shapes.markers, strict=True)
    ):
        share = number / max(1, count - 1)
        colour = f"rgb({', '.join(str(int(c)) for c in (1 - share) * _FIRST + share * _LAST)})"
        gaps = np.full((len(skin), 1, 2), np.nan)
        x, y = (1e3 * np.concatenate([skin, gaps], axis=1)).reshape(-1, 2).T
        name = f"{time:.2f} s"
        figure.add_trace(_lines(x, y, colour, name, number in (0, count - 1)))
        figure.add_trace(_dots(1e3 * markers[:3], colour, name))
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


def _dots(markers: np.ndarray, colour: str, name: str) -> go.Scatter:
    return go.Scatter(
        x=_rounded(markers[:, 0]),
        y=_rounded(markers[:, 1]),
        mode="markers",
        name=f"markers, {name}",
        showlegend=False,
        marker={"color": colour, "size": 5},
    )
