"""The error by level of the drive and by frequency."""

from collections.abc import Sequence

import plotly.graph_objects as go

from hasel_sysid.compare.comparison import Comparison
from hasel_sysid.report.figures.style import NOISE, model_colour, styled


def conditions_figures(comparisons: Sequence[Comparison]) -> list[go.Figure]:
    """Bars of mean |Δ sin θ| per level of the drive and per frequency, one colour per model, with the noise floor."""
    kinds = {
        "by drive": [comparison.by_level for comparison in comparisons],
        "by frequency": [comparison.by_frequency for comparison in comparisons],
    }
    highest = max(row.mean_absolute_error for kind in kinds.values() for rows in kind for row in rows)
    noise = 0.798 * comparisons[0].where.noise
    figures = []
    for title, kind in kinds.items():
        figure = go.Figure()
        for number, (comparison, rows) in enumerate(zip(comparisons, kind, strict=True)):
            figure.add_trace(
                go.Bar(
                    x=[row.label for row in rows],
                    y=[row.mean_absolute_error for row in rows],
                    name=comparison.label,
                    marker_color=model_colour(number, len(comparisons)),
                    hovertemplate="%{x}: %{y:.4f}<extra></extra>",
                )
            )
        figure.add_hline(y=noise, line={"color": NOISE, "dash": "dash", "width": 1.5})
        figure.update_yaxes(title_text="mean |Δ sin θ|", range=[0.0, 1.08 * highest])
        styled(figure, 280)
        heading = {"text": title, "font": {"size": 14}, "x": 0.5, "y": 0.96}
        figures.append(figure.update_layout(showlegend=False, title=heading, margin={"t": 40}))
    return figures
