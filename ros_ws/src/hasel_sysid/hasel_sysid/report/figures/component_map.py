"""How much each kind of difference accounts for in each run."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from hasel_sysid.compare.run_comparison import RunComparison
from hasel_sysid.report.figures.style import styled
from hasel_sysid.where_it_fails.component import Kind
from hasel_sysid.where_it_fails.sentences import words


def component_map_figure(runs: Sequence[RunComparison]) -> go.Figure | None:
    """Rms of sin theta per run and kind; None when nothing could be split."""
    kinds = [kind for kind in Kind if any(c.kind is kind for run in runs for c in run.analysis.components)]
    if not kinds:
        return None
    sizes = np.full((len(runs), len(kinds)), np.nan)
    texts = [["" for _ in kinds] for _ in runs]
    for row, run in enumerate(runs):
        for component in run.analysis.components:
            column = kinds.index(component.kind)
            sizes[row, column] = component.size
            texts[row][column] = words(component)
    figure = go.Figure(
        go.Heatmap(
            x=[kind.value for kind in kinds],
            y=[run.name for run in runs],
            z=sizes,
            zmin=0,
            customdata=texts,
            colorscale="Blues",
            texttemplate="%{z:.2r}",
            textfont={"size": 11},
            colorbar={"title": {"text": "rms of<br>sin θ"}, "thickness": 14},
            hovertemplate="%{y} %{customdata}: rms %{z:.3r}<extra></extra>",
        )
    )
    figure.update_yaxes(autorange="reversed", automargin=True)
    figure.update_xaxes(automargin=True, tickangle=-25)
    styled(figure, 190 + 24 * len(runs))
    return figure
