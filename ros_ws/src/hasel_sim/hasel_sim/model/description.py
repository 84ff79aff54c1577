# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A whole model file: what must fit together in it, and which effects can stand side by side on its body."""

from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import Any, Literal

from hasel_common.names import nearest_name
from pydantic import Field, model_validator

from hasel_sim.effects.base import Effect, Surroundings
from hasel_sim.errors import ModelError
from hasel_sim.model.muscle_law import MuscleLaw
from hasel_sim.model.sections import (
    Body,
    BodyRegion,
    Channel,
    Marker,
    Materials,
    Medium,
    MuscleRegion,
    Name,
    Numerics,
    ParameterEntry,
    Section,
)

ANGLE_MARKERS = ("head", "middle", "tail")
"""The markers whose positions give the angle."""

_SLACK = 1e-9
"""Lengths [m] are compared with this."""


class Description(Section):
    """A whole model file."""

    name: str
    body: Body
    material: Materials
    medium: Medium | None = None
    channels: tuple[Channel, ...] = ()
    muscles: tuple[MuscleRegion, ...] = ()
    muscle_response: Literal["sloped_box", "first_order"] = "sloped_box"
    """How muscles follow what is commanded: the contraction at a limited rate (`slope`), or the drive itself through a
    first-order lag (`rise_time`, `fall_time`), as the pressure in a chamber does."""
    muscle: MuscleLaw | None = None
    """The law that muscles driven by a voltage follow, in place of an amplitude per voltage."""
    markers: dict[Name, Marker]
    numerics: Numerics = Numerics()
    effects: tuple[str, ...] = ()
    parameters: dict[str, ParameterEntry] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _consistent(self) -> "Description":
        checks = (_spine, _medium, _places, _channels, _law, _markers)
        fault = next((fault for check in checks for fault in check(self)), None)
        if fault:
            raise ValueError(fault)
        return self

    @property
    def surroundings(self) -> Surroundings | None:
        """What the effects of a fluid need to know; None for a body without medium."""
        if self.medium is None or self.body.depth_m is None:
            return None
        return Surroundings(
            self.medium.density_kg_per_m3,
            self.medium.viscosity_pa_s,
            self.body.depth_m,
            self.body.whole_length_m,
        )

    def marker_names(self) -> tuple[str, ...]:
        """Head, middle and tail, then the others in the file's order."""
        return (*ANGLE_MARKERS, *(name for name in self.markers if name not in ANGLE_MARKERS))


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


def _on_the_body(kind: str, part: MuscleRegion | BodyRegion, d: Description) -> Iterator[str]:
    longest = d.body.whole_length_m if kind == "body.regions" and part.layer == "spine" else d.body.length_m
    if part.to_m <= part.from_m or part.to_m > longest + _SLACK:
        yield (
            f"{kind}: '{part.name}' runs from {part.from_m:g} to {part.to_m:g} m; expected a stretch of the body "
            f"between 0 and {longest:g} m: correct from_m and to_m"
        )
    if part.layer == "spine" and d.body.spine is None:
        yield f"{kind}: '{part.name}' lies in the spine, and this body has none: choose another layer"


def _apart(kind: str, one: MuscleRegion | BodyRegion, other: MuscleRegion | BodyRegion) -> Iterator[str]:
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
    for name in ANGLE_MARKERS:
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


def check_together(effects: tuple[Effect, ...], body: Description) -> None:
    """Refuse effects that cannot stand side by side, or not on this body, with a ModelError."""
    seen: dict[str, str] = {}
    for effect in effects:
        for word in filter(None, (effect.id, effect.exclusive)):
            if word in seen:
                reason = "is there twice" if seen[word] == effect.id else f"does the same as '{seen[word]}'"
                raise ModelError(
                    f"effect '{effect.id}' {reason}; expected one of each kind: remove one of the two"
                )
            seen[word] = effect.id
        count, quantities = len(body.muscles), sorted({channel.quantity for channel in body.channels})
        on = f"and model '{body.name}'"
        wrong = {
            f"acts on the muscles, {on} has none; remove it or use a model with muscles": (
                effect.needs_muscles and not count
            ),
            f"acts on the spine, {on} has none; remove it or use a model whose body has a spine": (
                effect.needs_spine and body.body.spine is None
            ),
            f"compares two muscles, {on} has {count}; remove it or use a model with two": (
                effect.needs_antagonists and count != 2
            ),
            f"is a force of the fluid around the body, {on} names none; remove it or add a section medium": (
                effect.needs_medium and body.medium is None
            ),
            f"acts on a {effect.quantity}, {on} is driven by {', '.join(quantities) or 'nothing'}; remove it or use a "
            "model with such a channel": effect.quantity and effect.quantity not in quantities,
        }
        for sentence in (sentence for sentence, found in wrong.items() if found):
            raise ModelError(f"effect '{effect.id}' {sentence}")
