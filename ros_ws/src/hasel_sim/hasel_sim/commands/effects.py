# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""List the physical effects, print what one of them states as a card, or write the documentation's page of all."""

import argparse
import sys
from collections.abc import Iterable

from hasel_sim.effects.base import Effect, EffectParameter
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.errors import HaselSimError

_DOCUMENT = """# Effects

Written by `ros2 run hasel_sim effects --table`; a test fails when it is stale. `ros2 run hasel_sim effects NAME` prints
one effect with its sources, its signature in the residual, and the experiment that separates it from its like. At the
null values the model is exactly the one without the effect. How to write one of your own:
[effects_of_your_own.md](../how_to/effects_of_your_own.md).
"""


def card(effect: Effect) -> str:
    """Everything an effect states."""
    lines = [f"{effect.id}  ({effect.place})", effect.physics, "", f"equation       {effect.equation}"]
    for parameter in effect.parameters:
        lines.append(f"parameter      {_parameter_line(parameter)}")
        if parameter.scan:
            tried = ", ".join(f"{value:g}" for value in parameter.scan)
            lines.append(f"               undefined at null; tried: {tried}")
        if parameter.source:
            lines.append(f"               source: {parameter.source}")
    rest = {
        "signature": effect.signature,
        "confused with": ", ".join(effect.confused_with),
        "separated by": effect.separated_by,
        "citation": effect.citation,
        "file": effect.source or "",
    }
    lines += [f"{title:15s}{text}" for title, text in rest.items() if text]
    return "\n".join(lines)


def _parameter_line(p: EffectParameter) -> str:
    unit = "" if p.unit == "1" else f" {p.unit}"
    null = "" if p.scan else f"null {p.null:g}{unit}, "
    return f"{p.name} ({p.symbol}): {null}plausible {p.lower:g} to {p.upper:g}{unit}, typical {p.typical:g}{unit}"


def overview(effects: Iterable[Effect]) -> str:
    """One line per effect: id, place and physics."""
    return "\n".join(f"{effect.id:24s}{effect.place:13s}{effect.physics}" for effect in effects)


def document(effects: Iterable[Effect]) -> str:
    """The documentation's page of all effects, in Markdown."""
    parts = [_DOCUMENT]
    by_place: dict[str, list[Effect]] = {}
    for effect in effects:
        by_place.setdefault(effect.place, []).append(effect)
    for place, members in by_place.items():
        parts.append(f"## {place.capitalize()}\n")
        parts.append("| id | physics | equation | parameters (null; plausible; typical) | confused with |")
        parts.append("|---|---|---|---|---|")
        parts += [_row(effect) for effect in members]
        parts.append("")
    return "\n".join(parts)


def _row(effect: Effect) -> str:
    numbers = "; ".join(_parameter_cell(p) for p in effect.parameters)
    alike = ", ".join(f"`{name}`" for name in effect.confused_with)
    return f"| `{effect.id}` | {effect.physics} | {effect.equation} | {numbers} | {alike} |"


def _parameter_cell(p: EffectParameter) -> str:
    unit = "1" if p.unit == "1" else p.unit
    null = "none" if p.scan else f"{p.null:g}"
    return f"{p.name} {p.symbol} [{unit}] ({null}; {p.lower:g} to {p.upper:g}; {p.typical:g})"


def run(options: argparse.Namespace) -> int:
    """Print what was asked for; returns the exit code."""
    try:
        if options.table:
            print(document(catalogue().values()), end="")
        elif options.names:
            print("\n\n".join(card(effect) for effect in find_effects(tuple(options.names))))
        else:
            print(overview(catalogue().values()))
    except HaselSimError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0
