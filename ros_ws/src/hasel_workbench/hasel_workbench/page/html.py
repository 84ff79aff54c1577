"""Tables, sliders and cards as plain HTML, so that a screen reader and a keyboard find their way in them."""

import math
from collections.abc import Sequence
from html import escape

import numpy as np
from hasel_sim.parameter import value_with_error
from hasel_sysid.comparison import RunComparison
from hasel_sysid.report.wording import error_text

from hasel_workbench.cards import Card
from hasel_workbench.failure_map import MapRow
from hasel_workbench.sliders import Slider


def runs_table(runs: Sequence[RunComparison]) -> str:
    """One row per run: a button that shows it, its drive and its error."""
    rows = "".join(
        f'<tr data-row="{escape(run.name)}"><td><button class="run" data-run="{escape(run.name)}">{escape(run.name)}'
        f"</button>{' <span class=chip>unseen</span>' if run.unseen else ''}</td>"
        f"<td>{escape(_drive(run))}</td>"
        f'<td class="number">{error_text(run.mean_absolute_error)}</td><td class="acts">{_acts(run)}</td></tr>'
        for run in runs
    )
    head = '<tr><th>run</th><th>drive</th><th class=number title="mean |Δ sin θ|">error</th><th></th></tr>'
    return f'<table class="runs"><thead>{head}</thead><tbody>{rows}</tbody></table>'


def _acts(run: RunComparison) -> str:
    """Two buttons: fit it or never fit it, and do without it."""
    name = escape(run.name)
    act, word = ("fit", "fit") if run.unseen else ("unseen", "unseen")
    said = f"fit {name} from now on" if run.unseen else f"never fit {name}"
    return (
        f'<button data-act="{act}" data-of="{name}" title="{said}" aria-label="{said}">{word}</button>'
        f'<button data-act="remove" data-of="{name}" title="remove {name}" aria-label="remove {name}">✕</button>'
    )


def _drive(run: RunComparison) -> str:
    frequency = f", {run.series.frequency:.2g} Hz" if run.series.frequency else ""
    return f"{run.series.level_text}{frequency}"


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


def sliders_list(shown: Sequence[Slider]) -> str:
    """A slider for every parameter; its value is moved by mouse or keyboard."""
    return "".join(_slider(each) for each in shown)


def _slider(each: Slider) -> str:
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
    rows = [
        ("equation", f"<code>{escape(card.equation)}</code>"),
        *(
            (f"parameter {escape(name)}", f"plausible {escape(plausible)}")
            for name, plausible in card.parameters
        ),
        ("signature", escape(card.signature)),
        ("looks like", escape(", ".join(card.confused_with))),
        ("separated by", escape(card.separated_by)),
        ("source", escape(card.citation)),
    ]
    said = f"<p class=said>{escape(card.said)}</p>" if card.said else ""
    listed = "".join(f"<dt>{name}</dt><dd>{text}</dd>" for name, text in rows if text)
    return f"{said}<dl>{listed}</dl>"


def parameter_table(before, after) -> str:
    """Values of the first step's and of the shown model, side by side."""
    rows = "".join(
        f"<tr><td>{escape(name)}</td><td class=number>"
        + (
            value_with_error(before[name].value, before[name].standard_error, p.unit)
            if name in before
            else "–"
        )
        + f"</td><td class=number>{value_with_error(p.value, p.standard_error, p.unit)}</td></tr>"
        for name, p in after.items()
    )
    return (
        "<table class=values><thead><tr><th>parameter</th><th class=number>at the start</th><th class=number>now</th>"
        f"</tr></thead><tbody>{rows}</tbody></table>"
    )
