# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Tables, sliders, cards and the waterfall as plain HTML, so that a screen reader and a keyboard find their way."""

import math
from collections.abc import Callable, Mapping, Sequence
from html import escape

import numpy as np
from hasel_sim.parameter import Parameter, value_with_error
from hasel_sysid.comparison import RunComparison
from hasel_sysid.report.wording import change_text, error_text
from nicegui import ui

from hasel_workbench.cards import Card, Slider
from hasel_workbench.curves import MapRow
from hasel_workbench.state import Waterfall


def markup(text: str) -> ui.html:
    """An element of the page; whoever makes the text escapes what comes from outside."""
    return ui.html(text, sanitize=False)


def section(label: str, title: str, css: str = "") -> ui.element:
    """A card of the page with a heading, to be filled in a `with`; label: for screen readers."""
    card = ui.element("section").classes(f"wb-card {css}").props(f'aria-label="{label}"')
    with card:
        markup(f"<h2>{title}</h2>")
    return card


def button(text: str, on_click: Callable[[], object], look: str = "outline") -> ui.button:
    """A flat or outlined button of this text."""
    return ui.button(text, on_click=on_click).props(f"dense no-caps {look}")


def runs_table(runs: Sequence[RunComparison]) -> str:
    """One row per run: a button that shows it, its drive and its error."""
    rows = "".join(map(_run_row, runs))
    head = '<tr><th>run</th><th>drive</th><th class=number title="mean |Δ sin θ|">error</th><th></th></tr>'
    return f'<table class="runs"><thead>{head}</thead><tbody>{rows}</tbody></table>'


def _run_row(run: RunComparison) -> str:
    """With two buttons: fit it or never fit it, and do without it."""
    name, chip = escape(run.name), " <span class=chip>unseen</span>" if run.unseen else ""
    frequency = f", {run.series.frequency:.2g} Hz" if run.series.frequency else ""
    act, said = ("fit", f"fit {name} from now on") if run.unseen else ("unseen", f"never fit {name}")
    return (
        f'<tr data-row="{name}"><td><button class="run" data-run="{name}">{name}</button>{chip}</td>'
        f"<td>{escape(run.series.level_text + frequency)}</td>"
        f'<td class="number">{error_text(run.mean_absolute_error)}</td><td class="acts">'
        f'<button data-act="{act}" data-of="{name}" title="{said}" aria-label="{said}">{act}</button>'
        f'<button data-act="remove" data-of="{name}" title="remove {name}" aria-label="remove {name}">✕</button>'
        "</td></tr>"
    )


def failure_map_table(rows: Sequence[MapRow]) -> str:
    """Runs by phase of the cycle; every cell can be clicked, or reached with the arrow keys."""
    if not rows:
        return "<p>No run has a cycle, so there is no phase to sort its error by.</p>"
    largest = max(float(np.nanmax(np.abs(row.mean))) for row in rows) or 1.0
    lines = "".join(
        f'<tr><th scope="row" title="{escape(row.run)}"><bdi>{escape(row.run)}</bdi></th>'
        + "".join(_cell(row, number, value, largest) for number, value in enumerate(row.mean))
        + "</tr>"
        for row in rows
    )
    return (
        '<table class="map" role="grid" aria-label="Measured minus simulated sin θ by run and part of the cycle">'
        f"<tbody>{lines}</tbody></table>"
        '<div class="scale"><span>cycle begins</span>'
        f'<span class="bar">−{error_text(largest)}<i></i>+{error_text(largest)}</span><span>ends</span></div>'
    )


def _cell(row: MapRow, number: int, value: float, largest: float) -> str:
    share = 0.0 if math.isnan(value) else min(1.0, abs(value) / largest)
    colour = "209,73,91" if value > 0 else "46,134,171"
    percent = 100 * (number + 0.5) / len(row.mean)
    said = f"{row.run}, {percent:.0f} % of the cycle: {value:+.4f}"
    return (
        f'<td role="gridcell" tabindex="-1" data-run="{escape(row.run)}" data-cell="{number}" '
        f'aria-label="{escape(said)}" title="{escape(said)}" style="background:rgba({colour},{share:.2f})"></td>'
    )


def slider_row(each: Slider) -> str:
    """A slider and a number field for a parameter; its value is moved by mouse or keyboard."""
    unit = "" if each.unit == "1" else f" {each.unit}"
    hint = " · ".join(filter(None, [each.meaning, each.plausible and f"plausible {each.plausible}"]))
    name, said = escape(each.name), escape(each.name + unit)
    return (
        f'<div class="tune" title="{escape(hint)}"><span>{name.replace(".", ".<wbr>")}</span>'
        f'<input type="range" min="0" max="1000" step="any" value="{1000 * each.share!r}" data-name="{name}" '
        f'data-low="{each.lowest!r}" data-high="{each.highest!r}" data-centre="{each.centre!r}" '
        f'data-size="{each.size!r}" data-value="{each.value!r}" data-unit="{escape(unit)}" aria-label="{said}" '
        f'aria-valuetext="{each.value:.4g}{escape(unit)}">'
        f'<input type="number" step="any" value="{each.value:.4g}" data-exact="{name}" aria-label="{said}, exactly">'
        f"<small>{escape(unit.strip())}</small></div>"
    )


def card_text(card: Card) -> str:
    """What is known of an effect."""
    effect = card.kind
    rows = [
        ("equation", f"<code>{escape(effect.equation)}</code>"),
        *((f"parameter {escape(name)}", f"plausible {escape(known)}") for name, known in card.parameters),
        ("signature", escape(effect.signature)),
        ("looks like", escape(", ".join(effect.confused_with))),
        ("separated by", escape(effect.separated_by)),
        ("source", escape(effect.citation)),
    ]
    said = "" if card.finding is None else f"<p class=said>{escape(str(card.finding))}</p>"
    listed = "".join(f"<dt>{name}</dt><dd>{text}</dd>" for name, text in rows if text)
    return f"{said}<dl>{listed}</dl>"


def parameter_table(before: Mapping[str, Parameter], after: Mapping[str, Parameter]) -> str:
    """Values of the first step's and of the shown model, side by side."""

    def shown(parameter: Parameter) -> str:
        return value_with_error(parameter.value, parameter.standard_error, parameter.unit)

    rows = "".join(
        f"<tr><td>{escape(name)}</td><td class=number>{shown(before[name]) if name in before else '–'}</td>"
        f"<td class=number>{shown(p)}</td></tr>"
        for name, p in after.items()
    )
    return (
        "<table class=values><thead><tr><th>parameter</th><th class=number>at the start</th><th class=number>now</th>"
        f"</tr></thead><tbody>{rows}</tbody></table>"
    )


_WIDTH, _HEIGHT, _LEFT, _TOP, _BOTTOM = 360, 210, 6, 36, 42


def waterfall_svg(falling: Waterfall) -> str:
    """Fitted and, where there are any, unseen runs at one scale; what is being tried is hatched."""
    groups: list[tuple[str, str, list[float]]] = [
        ("fitted runs", "fitted", [s.error for s in falling.stages if s.error is not None])
    ]
    unseen = [s.error_unseen for s in falling.stages if s.error_unseen is not None]
    if len(unseen) == len(falling.stages):
        groups.append(("unseen runs", "unseen", unseen))
    highest = max(error for *_, errors in groups for error in errors)
    drawn = "".join(_group(*group, highest, falling) for group in groups)
    return f'<div class="wb-waterfalls">{drawn}</div>'


def _group(title: str, kind: str, errors: Sequence[float], highest: float, falling: Waterfall) -> str:
    labels = [stage.label for stage in falling.stages]
    pitch = (_WIDTH - 2 * _LEFT) / max(len(errors) + (len(errors) > 1), 3)
    most = max(4, int(pitch / 6.2))
    scale = (_HEIGHT - _TOP - _BOTTOM) / (1.06 * highest)

    def y(error: float) -> float:
        return _HEIGHT - _BOTTOM - scale * error

    said = "; ".join(f"{label} {error_text(error)}" for label, error in zip(labels, errors, strict=True))
    parts = [
        f'<svg class="waterfall" viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" '
        f'aria-label="Mean error on {title}, step by step: {escape(said)}">',
        f'<text class="title" x="{_LEFT}" y="14">{title}</text>',
    ]
    bars = [(0.0, errors[0], f"total {kind}", error_text(errors[0]), labels[0])]
    for number, (before, after) in enumerate(zip(errors, errors[1:], strict=False), start=1):
        sort = "drop" if after <= before else "rise"
        tried = " tried" if falling.tried and number == len(errors) - 1 else ""
        bars.append((before, after, sort + tried, change_text(after - before), labels[number]))
    if len(errors) > 1:
        bars.append((0.0, errors[-1], f"total {kind}", error_text(errors[-1]), "left over"))
    for number, (before, after, css, text, label) in enumerate(bars):
        left, top = _LEFT + number * pitch, y(max(before, after))
        height = max(1.0, abs(before - after) * scale)
        middle, short = left + 0.45 * pitch, label if len(label) <= most else label[: most - 1] + "…"
        parts.append(
            f'<rect class="{css}" x="{left:.1f}" y="{top:.1f}" width="{0.9 * pitch:.1f}" height="{height:.1f}"/>'
            f'<text class="number" x="{middle:.1f}" y="{top - 4:.1f}">{text}</text>'
            f'<text class="label" x="{middle:.1f}" y="{_HEIGHT - _BOTTOM + 14}">'
            f"{escape(short)}<title>{escape(label)}</title></text>"
        )
    floor = y(falling.noise_floor)
    if floor > _TOP:
        ends = f'x1="{_LEFT}" x2="{_WIDTH - _LEFT}" y1="{floor:.1f}" y2="{floor:.1f}"'
        parts.append(f'<line class="noise" {ends}/>')
    note = f"dashed: noise floor {error_text(falling.noise_floor)}"
    parts.append(f'<text class="noise" x="{_LEFT}" y="{_HEIGHT - 4}">{note}</text>')
    return "".join(parts) + "</svg>"
