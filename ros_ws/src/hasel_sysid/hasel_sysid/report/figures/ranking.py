"""The effects by probability, with the share of the error that each removes."""

from collections.abc import Sequence

import plotly.graph_objects as go

from hasel_sysid.report.content import RankedRow
from hasel_sysid.report.figures.style import FITTED, MODELS, styled


def ranking_figure(ranking: Sequence[RankedRow], most: int = 8) -> go.Figure:
    """Horizontal bars, most probable on top."""
    shown = list(ranking)[:most]
    names = [row.effect for row in shown]
    figure = go.Figure()
    for name, colour, values in (
        ("probability", FITTED, [row.probability for row in shown]),
        (
            "error removed",
            MODELS[3],
            [row.error_removed for row in shown],
        ),
    ):
        figure.add_trace(
            go.Bar(
                y=names,
                x=[100 * value if value == value else None for value in values],
                name=name,
                orientation="h",
                marker_color=colour,
                hovertemplate="%{y}: %{x:.0f} %%<extra></extra>",
            )
        )
    figure.update_yaxes(autorange="reversed", automargin=True)
    figure.update_xaxes(title_text="%", range=[0, 100])
    styled(figure, 130 + 34 * len(shown))
    return figure.update_layout(barmode="group", bargap=0.35, margin={"t": 60})
