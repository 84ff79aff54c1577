# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The report's figures, each a function from content to plotly's."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go

from hasel_sysid.comparison import Comparison, RunComparison
from hasel_sysid.report.content import RankedRow, StageRow, known_errors
from hasel_sysid.report.shape import Shapes
from hasel_sysid.report.style import (
    AXIS,
    DROP,
    FITTED,
    MODELS,
    NOISE,
    OF_RUNS,
    RISE,
    base_layout,
    model_colour,
)
from hasel_sysid.report.wording import change_text, error_text
from hasel_sysid.residual_analysis.component import Kind, words

_MOST_RANKED = 8
_COLOURS = ("#8a949e", "#2e86ab", "#d1495b")


def waterfall_figures(stages: Sequence[StageRow], noise_floor: float | None) -> list[go.Figure]:
    """One waterfall for the fitted runs and, where there are any, one for the unseen runs, at one scale."""
    groups = known_errors(stages)
    highest = max(error for known in groups.values() for _, error in known)
    floor = "" if noise_floor is None else f"<br><sup>dashed: noise floor {error_text(noise_floor)}</sup>"
    figures = []
    for name, known in groups.items():
        figure = go.Figure()
        _add_waterfall(figure, name, known, OF_RUNS[name])
        if noise_floor is not None:
            figure.add_hline(y=noise_floor, line={"color": NOISE, "dash": "dash", "width": 1.5})
        figure.update_yaxes(title_text="mean |Δ sin θ|", range=[0.0, 1.12 * highest])
        figure.update_xaxes(automargin=True)
        figures.append(_titled(figure, 360, name + floor, margin={"t": 58}))
    return figures


def styled(figure: go.Figure, height: int) -> go.Figure:
    """Apply fonts, grid and margins; height in pixels."""
    figure.update_layout(base_layout(height))
    figure.update_xaxes(AXIS, ticks="outside", ticklen=4)
    figure.update_yaxes(AXIS)
    return figure


def _titled(figure: go.Figure, height: int, title: str, **layout: Any) -> go.Figure:
    heading = {"text": title, "font": {"size": 14}, "x": 0.5, "y": 0.96}
    return styled(figure, height).update_layout(showlegend=False, title=heading, **layout)


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


def ranking_figure(ranking: Sequence[RankedRow]) -> go.Figure:
    """Horizontal bars, most probable on top."""
    shown = list(ranking)[:_MOST_RANKED]
    names = [row.effect for row in shown]
    figure = go.Figure()
    for name, colour, values in (
        ("probability", FITTED, [row.probability for row in shown]),
        ("error removed", MODELS[3], [row.error_removed for row in shown]),
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
    return styled(figure, 130 + 34 * len(shown)).update_layout(barmode="group", bargap=0.35, margin={"t": 60})


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
        figures.append(_titled(figure, 280, title, margin={"t": 40}))
    return figures


def phase_map_figure(runs: Sequence[RunComparison]) -> go.Figure | None:
    """Mean residual per run and phase; None when no run has a cycle."""
    shown = [(run, run.analysis.profile) for run in runs if run.analysis.profile is not None]
    if not shown:
        return None
    values = np.array([profile.mean for _, profile in shown])
    largest = float(np.nanmax(np.abs(values))) or 1.0
    phase = shown[0][1].phase * 100
    figure = go.Figure(
        go.Heatmap(
            x=phase,
            y=[run.name for run, _ in shown],
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
        title_text="part of the cycle [%], beginning where the first muscle is switched on", range=[0, 100]
    )
    figure.update_yaxes(autorange="reversed", automargin=True)
    return styled(figure, 150 + 24 * len(shown)).update_xaxes(showgrid=False)


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
    return styled(figure, 190 + 24 * len(runs))


def residual_tests_figures(runs: Sequence[RunComparison]) -> list[go.Figure]:
    """Autocorrelation, and cross-correlation with the command, per run, with the 99 % bands of the median run."""
    white = [(run.name, run.analysis.whiteness) for run in runs if run.analysis.whiteness is not None]
    driven = [
        (run.name, run.analysis.drive_dependence) for run in runs if run.analysis.drive_dependence is not None
    ]
    figures = []
    if white:
        curves = [_correlation_line(name, test.lag_time, test.autocorrelation) for name, test in white]
        band = float(np.median([np.median(test.band) for _, test in white]))
        figures.append(_correlations("residual with itself", curves, band))
    if white and driven:
        curves = [_correlation_line(name, test.lag_time, test.correlation) for name, test in driven]
        band = float(np.median([test.band for _, test in driven]))
        figures.append(_correlations("residual with the command before it", curves, band))
    return figures


def _correlations(title: str, curves: Sequence[go.Scatter], band: float) -> go.Figure:
    figure = go.Figure(curves)
    half = min(band, 1.0)
    figure.add_hrect(y0=-half, y1=half, fillcolor=NOISE, opacity=0.18, line_width=0)
    figure.update_xaxes(title_text="lag [ms]")
    figure.update_yaxes(title_text="correlation", range=[-1.05, 1.05])
    return _titled(figure, 300, title)


def _correlation_line(name: str, lag: np.ndarray, value: np.ndarray) -> go.Scatter:
    return go.Scatter(
        x=lag * 1e3,
        y=value,
        name=name,
        mode="lines",
        line={"color": MODELS[1], "width": 1.2},
        opacity=0.65,
        hovertemplate=f"{name}, %{{x:.0f}} ms: %{{y:.2f}}<extra></extra>",
    )


def shapes_figure(shapes: Shapes) -> go.Figure:
    """Grey at first, then blue and red; rings are the simulated markers, dots the measured ones."""
    figure = go.Figure()
    for time, skin, markers, measured, colour in zip(
        shapes.time, shapes.skin, shapes.markers, shapes.measured, _COLOURS, strict=False
    ):
        gaps = np.full((len(skin), 1, 2), np.nan)
        x, y = (1e3 * np.concatenate([skin, gaps], axis=1)).reshape(-1, 2).T
        name = f"{time:.2f} s"
        figure.add_trace(_outline(x, y, colour, name, True))
        figure.add_trace(_marker_dots(1e3 * markers, colour, f"simulated, {name}", "circle-open", 11))
        figure.add_trace(_marker_dots(1e3 * measured, colour, f"measured, {name}", "circle", 6))
    figure.update_yaxes(title_text="y [mm]", scaleanchor="x", constrain="domain")
    figure.update_xaxes(title_text="x [mm]", constrain="domain")
    return styled(figure, 320)


def _rounded(series: np.ndarray) -> list[float | None]:
    return [None if np.isnan(value) else round(float(value), 2) for value in series]


def _outline(x: np.ndarray, y: np.ndarray, colour: str, name: str, shown: bool) -> go.Scatter:
    return go.Scatter(
        x=_rounded(x),
        y=_rounded(y),
        mode="lines",
        name=name,
        showlegend=shown,
        hoverinfo="name",
        line={"color": colour, "width": 1.3},
    )


def _marker_dots(markers: np.ndarray, colour: str, name: str, symbol: str, size: int) -> go.Scatter:
    return go.Scatter(
        x=_rounded(markers[:, 0]),
        y=_rounded(markers[:, 1]),
        mode="markers",
        name=name,
        showlegend=False,
        marker={"color": colour, "size": size, "symbol": symbol},
    )
