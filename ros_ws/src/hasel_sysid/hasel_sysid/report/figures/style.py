"""One look for all figures."""

import plotly.graph_objects as go

MEASURED = "#30363d"
MODELS = ("#d1495b", "#2e86ab", "#edae49", "#66a182", "#8d6a9f", "#5c6b73")
FITTED, UNSEEN, NOISE = "#2e86ab", "#edae49", "#8a949e"
DROP, RISE = "#8fc3a3", "#d1495b"
GRID = "#e6e9ec"
FONT = "Inter, system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"


def styled(figure: go.Figure, height: int) -> go.Figure:
    """Apply fonts, grid and margins; height in pixels."""
    figure.update_layout(
        height=height,
        font={"family": FONT, "size": 13, "color": "#24292f"},
        paper_bgcolor="white",
        plot_bgcolor="white",
        margin={"l": 60, "r": 20, "t": 44, "b": 48},
        hoverlabel={"font": {"family": FONT}},
        legend={"orientation": "h", "y": 1.0, "yanchor": "top", "x": 0.05, "yref": "container"},
    )
    figure.update_xaxes(gridcolor=GRID, zerolinecolor=GRID, linecolor="#c3c9cf", ticks="outside", ticklen=4)
    figure.update_yaxes(gridcolor=GRID, zerolinecolor=GRID, linecolor="#c3c9cf")
    return figure
