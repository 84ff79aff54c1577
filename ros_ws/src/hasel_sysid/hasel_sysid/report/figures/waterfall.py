"""The error falling, stage by stage, down to the noise."""

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go

from hasel_sysid.report.content import StageRow
from hasel_sysid.report.figures.style import DROP, FITTED, NOISE, RISE, UNSEEN, styled
from hasel_sysid.report.numbers import change_text, error_text


def waterfall_figures(stages: Sequence[StageRow], noise_floor: float | None) -> list[go.Figure]:
    """One waterfall for the fitted runs and, where there are any, one for the unseen runs, at one scale."""
    groups = [("fitted runs", [s.error for s in stages], FITTED)]
    if any(stage.error_unseen is not None for stage in stages):
        groups.append(("unseen runs", [s.error_unseen for s in stages], UNSEEN))
    highest = max(error for _, errors, _ in groups for error in errors if error is not None)
    floor = "" if noise_floor is None else f"<br><sup>dashed: noise floor {error_text(noise_floor)}</sup>"
    figures = []
    for name, errors, colour in groups:
        known = [
            (stage.label, error) for stage, error in zip(stages, errors, strict=True) if error is not None
        ]
        figure = go.Figure()
        _add_waterfall(figure, name, known, colour)
        if noise_floor is not None:
            figure.add_hline(y=noise_floor, line={"color": NOISE, "dash": "dash", "width": 1.5})
        figure.update_yaxes(title_text="mean |Δ sin θ|", range=[0.0, 1.12 * highest])
        figure.update_xaxes(automargin=True)
        styled(figure, 360)
        title = {"text": name + floor, "font": {"size": 14}, "x": 0.5, "y": 0.96}
        figures.append(figure.update_layout(showlegend=False, title=title, margin={"t": 58}))
    return figures


def _add_waterfall(figure: go.Figure, name: str, known: Sequence[tuple[str, float]], colour: str) -> None:
    """Bars for the first error, every change and what is left, each with its number above it."""
    errors = [error for _, error in known]
    changes = list(np.diff(errors))
    bars = go.Waterfall(
        name=name,
        x=[*(label for label, _ in known), "left over"],
        y=[errors[0], *changes, errors[-1]],
        measure=["absolute", *["relative"] * len(changes), "total"],
        decreasing={"marker": {"color": DROP}},
        increasing={"marker": {"color": RISE}},
        totals={"marker": {"color": colour}},
        connector={"line": {"color": "#c3c9cf", "width": 1}},
    )
    figure.add_trace(bars)
    tops = [errors[0], *np.maximum(errors[:-1], errors[1:]), errors[-1]]
    texts = [error_text(errors[0]), *map(change_text, changes), f"<b>{error_text(errors[-1])}</b>"]
    for place, (top, text) in enumerate(zip(tops, texts, strict=True)):
        figure.add_annotation(x=place, y=top, text=text, showarrow=False, yshift=10)
