"""What must fit together in a model file: materials, places on the body, muscles and their channels, markers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import TYPE_CHECKING, Any

from hasel_common.names import nearest_name

if TYPE_CHECKING:
    from hasel_sim.model.actuation import Muscle
    from hasel_sim.model.body import BodyRegion
    from hasel_sim.model.description import Description

_SLACK = 1e-9
"""Lengths [m] are compared with this."""


def first_fault(description: Description) -> str | None:
    """A sentence about the first thing that does not fit; None where all does."""
    checks = (_spine, _medium, _places, _channels, _law, _markers)
    return next((fault for check in checks for fault in check(description)), None)


def _spine(d: Description) -> Iterator[str]:
    if d.body.spine and d.material.spine is None:
        yield "body.spine has no material; expected material.spine: add that section"
    if d.material.spine and d.body.spine is None:
        yield "material.spine belongs to no spine; expected body.spine with thickness_m: add it or remove the material"


def _medium(d: Description) -> Iterator[str]:
    if d.medium and d.body.depth_m is None:
        yield (
            "medium is given for a body without depth; expected body.depth_m, how far it reaches out of the plane: add "
            "it"
        )


def _places(d: Description) -> Iterator[str]:
    named: dict[str, Sequence[Any]] = {"muscles": d.muscles, "body.regions": d.body.regions}
    for kind, parts in named.items():
        for part in parts:
            yield from _on_the_body(kind, part, d)
        for one, other in combinations(parts, 2):
            if one.name == other.name:
                yield f"{kind}: the name '{one.name}' is there twice; expected one of each: rename one"
            yield from _apart(kind, one, other)


def _on_the_body(kind: str, part: Muscle | BodyRegion, d: Description) -> Iterator[str]:
    longest = d.body.whole_length_m if kind == "body.regions" and part.layer == "spine" else d.body.length_m
    if part.to_m <= part.from_m or part.to_m > longest + _SLACK:
        yield (
            f"{kind}: '{part.name}' runs from {part.from_m:g} to {part.to_m:g} m; expected a stretch of the body "
            f"between 0 and {longest:g} m: correct from_m and to_m"
        )
    if part.layer == "spine" and d.body.spine is None:
        yield f"{kind}: '{part.name}' lies in the spine, and this body has none: choose another layer"


def _apart(kind: str, one: Muscle | BodyRegion, other: Muscle | BodyRegion) -> Iterator[str]:
    first, second = one.stretch, other.stretch
    shared = set(first.layers) & set(second.layers)
    start, end = max(first.start, second.start), min(first.end, second.end)
    if shared and start < end - _SLACK:
        yield (
            f"{kind}: '{one.name}' and '{other.name}' overlap from {start:g} to {end:g} m; expected one at every "
            "place of a layer: shorten one or choose another layer"
        )


def _channels(d: Description) -> Iterator[str]:
    names = [channel.name for channel in d.channels]
    for name in names:
        if names.count(name) > 1:
            yield f"channels: the name '{name}' is there twice; expected one of each: rename one"
    for muscle in d.muscles:
        if muscle.channel not in names:
            yield (
                f"muscle '{muscle.name}' is contracted by channel '{muscle.channel}', which channels does not list; "
                f"{nearest_name(muscle.channel, names)}: add the channel or correct the name"
            )
    used = {muscle.channel for muscle in d.muscles}
    for name in names:
        if name not in used:
            yield f"channel '{name}' contracts no muscle; expected one that names it: add it or remove the channel"


def _law(d: Description) -> Iterator[str]:
    if d.muscle and all(channel.quantity != "voltage" for channel in d.channels):
        yield (
            f"muscle.law is '{d.muscle.law}', and no channel is a voltage; expected one: remove the section, or "
            "correct the channel's quantity"
        )


def _markers(d: Description) -> Iterator[str]:
    for name in ("head", "middle", "tail"):
        if name not in d.markers:
            yield f"markers has no '{name}'; expected head, middle and tail, which give the angle: add it"
    for name, marker in d.markers.items():
        if marker.fixed:
            continue
        length = d.body.whole_length_m
        if not -_SLACK <= marker.x_m <= length + _SLACK:
            yield (
                f"markers.{name}.x_m is {marker.x_m:g}; expected 0 to {length:g} m, a place on the body: correct "
                "it or set fixed: true for a marker of the rig"
            )
        elif abs(marker.y_m) > d.body.half_height_at(marker.x_m) + _SLACK:
            yield (
                f"markers.{name}.y_m is {marker.y_m:g}; expected at most {d.body.half_height_at(marker.x_m):.4g} m "
                "from the centre line there, a place on the body: correct it or set fixed: true"
            )
