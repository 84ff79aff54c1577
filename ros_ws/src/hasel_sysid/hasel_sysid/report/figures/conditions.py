"""The error by level of the drive and by frequency."""

from collections.abc import Sequence

import plotly.graph_objects as go
from plotly.subplots import make_subplots

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.report.figures.style import MODELS, NOISE, styled


def conditions_figure(comparisons: Sequence[Comparison]) -> go.Figure:
    """Bars of mean |Δ sin θ| per level of the drive and per frequency, one colour per model, with the noise floor."""
    figure = make_subplots(
        rows=1,
        cols=2,
        subplot_titles=["by drive", "by frequency"],
        shared_yaxes=True,
        horizontal_spacing=0.05,
    )
    for number, comparison in enumerate(comparisons):
        for column, rows in enumerate((comparison.by_level, comparison.by_frequency), start=1):
            figure.add_trace(
                go.Bar(
                    x=[row.label for row in rows],
                    y=[row.mean_absolute_error for row in rows],
                    name=comparison.label,
                    legendgroup=comparison.label,
                    showlegend=column == 1 and len(comparisons) > 1,
                    marker_color=MODELS[number % len(MODELS)],
                    hovertemplate="%{x}: %{y:.4f}<extra></extra>",
                ),
                row=1,
                col=column,
            )
    noise = 0.798 * comparisons[0].where.noise
    figure.add_hline(y=noise, line={"color": NOISE, "dash": "dash", "width": 1.5})
    figure.update_yaxes(title_text="mean |Δ sin θ|", col=1)
    styled(figure, 310)
    return figure.update_layout(margin={"t": 64})
