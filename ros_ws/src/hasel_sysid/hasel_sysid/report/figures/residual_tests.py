"""Whiteness of the residuals and what they still owe to the command."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from hasel_sysid.compare.run_comparison import RunComparison
from hasel_sysid.report.figures.style import MODELS, NOISE, styled


def residual_tests_figures(runs: Sequence[RunComparison]) -> list[go.Figure]:
    """Autocorrelation, and cross-correlation with the command, per run, with the 99 % bands of the median run."""
    white = [(run.name, run.analysis.whiteness) for run in runs if run.analysis.whiteness is not None]
    driven = [
        (run.name, run.analysis.drive_dependence) for run in runs if run.analysis.drive_dependence is not None
    ]
    figures = []
    if white:
        curves = [_line(name, test.lag_time, test.autocorrelation) for name, test in white]
        band = float(np.median([np.median(test.band) for _, test in white]))
        figures.append(_figure("residual with itself", curves, band))
    if white and driven:
        curves = [_line(name, test.lag_time, test.correlation) for name, test in driven]
        band = float(np.median([test.band for _, test in driven]))
        figures.append(_figure("residual with the command before it", curves, band))
    return figures


def _figure(title: str, curves: Sequence[go.Scatter], band: float) -> go.Figure:
    figure = go.Figure(curves)
    half = min(band, 1.0)
    figure.add_hrect(y0=-half, y1=half, fillcolor=NOISE, opacity=0.18, line_width=0)
    figure.update_xaxes(title_text="lag [ms]")
    figure.update_yaxes(title_text="correlation", range=[-1.05, 1.05])
    styled(figure, 300)
    heading = {"text": title, "font": {"size": 14}, "x": 0.5, "y": 0.96}
    return figure.update_layout(showlegend=False, title=heading)


def _line(name: str, lag: np.ndarray, value: np.ndarray) -> go.Scatter:
    return go.Scatter(
        x=lag * 1e3,
        y=value,
        name=name,
        mode="lines",
        line={"color": MODELS[1], "width": 1.2},
        opacity=0.65,
        hovertemplate=f"{name}, %{{x:.0f}} ms: %{{y:.2f}}<extra></extra>",
    )
