"""Whiteness of the residuals and what they still owe to the command."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from hasel_sysid.compare.run_comparison import RunComparison
from hasel_sysid.report.figures.style import MODELS, NOISE, styled


def residual_tests_figure(runs: Sequence[RunComparison]) -> go.Figure | None:
    """Autocorrelation, and cross-correlation with the command, per run, with the 99 % bands of the median run."""
    white = [run for run in runs if run.analysis.whiteness is not None]
    driven = [run for run in runs if run.analysis.drive_dependence is not None]
    if not white:
        return None
    titles = ["residual with itself", "residual with the command before it"][: 2 if driven else 1]
    figure = make_subplots(
        rows=1, cols=len(titles), subplot_titles=titles, shared_yaxes=True, horizontal_spacing=0.05
    )
    for run in white:
        test = run.analysis.whiteness
        figure.add_trace(_line(run.name, test.lag_time, test.autocorrelation), row=1, col=1)
    _band(figure, float(np.median([np.median(run.analysis.whiteness.band) for run in white])), 1)
    for run in driven:
        test = run.analysis.drive_dependence
        figure.add_trace(_line(run.name, test.lag_time, test.correlation), row=1, col=2)
    if driven:
        _band(figure, float(np.median([run.analysis.drive_dependence.band for run in driven])), 2)
    figure.update_xaxes(title_text="lag [ms]")
    figure.update_yaxes(range=[-1.05, 1.05])
    figure.update_yaxes(title_text="correlation", col=1)
    styled(figure, 320)
    return figure.update_layout(showlegend=False)


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


def _band(figure: go.Figure, half_width: float, column: int) -> None:
    figure.add_hrect(
        y0=-min(half_width, 1.0),
        y1=min(half_width, 1.0),
        fillcolor=NOISE,
        opacity=0.18,
        line_width=0,
        row=1,
        col=column,
    )
