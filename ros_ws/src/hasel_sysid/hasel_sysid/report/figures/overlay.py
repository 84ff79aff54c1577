"""Measured against simulated angle, one small plot per run."""

from collections.abc import Sequence

import plotly.graph_objects as go
from plotly.subplots import make_subplots

from hasel_sysid.report.content import RunOverlay
from hasel_sysid.report.decimate import decimate
from hasel_sysid.report.figures.style import MEASURED, MODELS, styled

_ROW_HEIGHT = 215


def overlay_figure(runs: Sequence[RunOverlay]) -> go.Figure:
    """All runs, three in a row; every model can be switched off in the legend."""
    columns = min(3, len(runs))
    rows = -(-len(runs) // columns)
    figure = make_subplots(
        rows=rows,
        cols=columns,
        subplot_titles=[_title(run) for run in runs],
        shared_yaxes=True,
        horizontal_spacing=0.035,
        vertical_spacing=min(0.12, 0.30 / rows),
    )
    models = list(dict.fromkeys(label for run in runs for label in run.simulated))
    for index, run in enumerate(runs):
        where = {"row": index // columns + 1, "col": index % columns + 1}
        time, measured = decimate(run.time, run.measured)
        figure.add_trace(
            go.Scatter(
                x=time,
                y=measured,
                name="measured",
                legendgroup="measured",
                showlegend=index == 0,
                mode="markers",
                marker={"color": MEASURED, "size": 5, "opacity": 0.3},
            ),
            **where,
        )
        for number, label in enumerate(models):
            if label not in run.simulated:
                continue
            time, simulated = decimate(run.time, run.simulated[label])
            last = number == len(models) - 1
            line = {"color": MODELS[number % len(MODELS)], "width": 2 if last else 1.4}
            figure.add_trace(
                go.Scatter(
                    x=time,
                    y=simulated,
                    name=label,
                    legendgroup=label,
                    showlegend=index == 0,
                    mode="lines",
                    line=line if last else {**line, "dash": "dot"},
                ),
                **where,
            )
    figure.update_xaxes(title_text="time [s]", title_standoff=4, row=rows)
    figure.update_yaxes(title_text="sin θ", title_standoff=4, col=1)
    styled(figure, 90 + _ROW_HEIGHT * rows)
    figure.update_layout(margin={"t": 74}, legend={"itemsizing": "constant"})
    figure.update_annotations(font_size=12.5)
    return figure


def _title(run: RunOverlay) -> str:
    name = (
        ", ".join(filter(None, [run.drive, f"{run.frequency:.2g} Hz" if run.frequency else ""])) or run.name
    )
    return f"{name} · unseen" if run.unseen else name
