"""The residual of every run by phase of the drive's cycle."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from hasel_sysid.compare.run_comparison import RunComparison
from hasel_sysid.report.figures.style import styled


def phase_map_figure(runs: Sequence[RunComparison]) -> go.Figure | None:
    """Mean residual per run and phase; None when no run has a cycle."""
    shown = [run for run in runs if run.analysis.profile is not None]
    if not shown:
        return None
    values = np.array([run.analysis.profile.mean for run in shown])
    largest = float(np.nanmax(np.abs(values))) or 1.0
    phase = shown[0].analysis.profile.phase * 100
    figure = go.Figure(
        go.Heatmap(
            x=phase,
            y=[run.name for run in shown],
            z=values,
            zmin=-largest,
            zmax=largest,
            colorscale="RdBu_r",
            colorbar={"title": {"text": "measured −<br>simulated"}, "thickness": 14, "tickformat": ".3g"},
            hovertemplate="%{y}, %{x:.0f} %% of the cycle: %{z:.4f}<extra></extra>",
        )
    )
    figure.add_vline(x=50, line={"color": "#57606a", "width": 1, "dash": "dot"})
    figure.update_xaxes(
        title_text="part of the cycle [%], beginning where the first muscle is switched on",
        range=[0, 100],
    )
    figure.update_yaxes(autorange="reversed", automargin=True)
    styled(figure, 150 + 24 * len(shown))
    figure.update_xaxes(showgrid=False)
    return figure
