# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a model may lack or have wrong: effects of the catalogue, and constants of its own file, in one list."""

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace

import numpy as np
from hasel_sim.effects.base import Effect, EffectParameter
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.errors import ModelError
from hasel_sim.model import Model
from hasel_sim.model.model_parameters import constants, unit_of

_RANGE, _TYPICAL = (0.3, 3.0), 1.2
"""How far a constant may be from what the file says, as the scale of a modulus may, and what one would notice."""


@dataclass(frozen=True)
class Candidate:
    """name: id of an effect, or path of a constant; parameters: each with null, typical value and plausible range;
    effect: None for a constant.
    """

    name: str
    parameters: tuple[EffectParameter, ...]
    effect: Effect | None = None

    @property
    def is_constant(self) -> bool:
        """Whether it is a number of the model file, and no effect."""
        return self.effect is None

    def path(self, parameter: EffectParameter) -> str:
        """Name of one of its parameters in a model."""
        return self.name if self.effect is None else f"{self.name}.{parameter.name}"

    @property
    def sizes(self) -> dict[str, EffectParameter]:
        """What says how large it is, by name in a model."""
        return {self.path(p): p for p in self.parameters if not p.scan}

    @property
    def coordinates(self) -> dict[str, EffectParameter]:
        """A time or a place, which means nothing while the size is null, by name in a model."""
        return {self.path(p): p for p in self.parameters if p.scan}

    @property
    def is_signed(self) -> bool:
        """Whether its sizes may lie on either side of their nulls."""
        return all(p.lower < p.null < p.upper for p in self.sizes.values())

    @property
    def acts_at_a_place(self) -> bool:
        """Whether a coordinate is a place, or a strain from which on it acts, and no time: what acts where the body
        hardly moves does nothing there, and much on either side, so that no derivative leads from one to another.
        """
        return any(p.unit != "s" for p in self.coordinates.values())

    @property
    def names(self) -> tuple[str, ...]:
        """Of all its parameters in a model."""
        return tuple(self.path(p) for p in self.parameters)

    def added_to(self, model: Model) -> Model:
        """The model with it at its null. Raises ModelError where it does not fit in."""
        if self.effect is not None:
            return model.with_effects(self.effect.source or self.effect.id)
        freed, (p,) = model.with_freed(self.name), self.parameters
        own = replace(freed.parameters[self.name], lower=p.lower, upper=p.upper)
        return replace(freed, parameters={**freed.parameters, self.name: own})

    def is_possible_in(self, model: Model) -> bool:
        """Whether a model file may say what the model has for it."""
        if self.effect is not None:
            return True
        try:
            model.with_constants_settled(self.name)
        except ModelError:
            return False
        return True


def compatible(candidates: Collection[Candidate]) -> bool:
    """Whether these may be in one model: no two that do the same, and a constant only alone.

    A number of the file that is wrong is to be measured before effects are believed in beside it.
    """
    if len(candidates) > 1 and any(candidate.is_constant for candidate in candidates):
        return False
    words = [w for c in candidates for w in (c.name, c.effect.exclusive if c.effect else "") if w]
    return len(words) == len(set(words))


def named_effects(only: Iterable[str] | None) -> tuple[Effect, ...]:
    """The effects of these names, with or without a + before them. Raises ModelError for an unknown one."""
    return find_effects(tuple(name.removeprefix("+") for name in only or ()))


def candidate_effects(model: Model, only: Iterable[str] | None = None) -> list[Effect]:
    """Effects that could be added to this model, less those that do not fit it.

    only: the ones to consider; all of the catalogue and these where one is written with a + before it; default: all of
    the catalogue. Raises ModelError for an unknown effect.
    """
    named = tuple(only or ())
    own = named_effects(named)
    every = not named or any(name.startswith("+") for name in named)
    effects = {effect.id: effect for effect in (*(catalogue().values() if every else ()), *own)}
    present = {effect.id for effect in model.effects}
    return [e for e in effects.values() if e.id not in present and _fits(model, e)]


def effects_of(model: Model, only: Iterable[str] | None = None) -> list[Candidate]:
    """The effects that could be added, as candidates."""
    return [Candidate(e.id, e.parameters, e) for e in candidate_effects(model, only)]


def constants_of(model: Model) -> list[Candidate]:
    """The constants that the model's file gives and that are no parameters yet; one of 0 has no range."""
    known = constants(model.description)
    return [_constant(name, v) for name, v in known.items() if v and name not in model.parameters]


def _constant(name: str, value: float) -> Candidate:
    lower, upper = np.sort(np.multiply(_RANGE, value)).tolist()
    p = EffectParameter(name, "", unit_of(name), value, lower, upper, _TYPICAL * value, "the model file")
    return Candidate(name, (p,))


def _fits(model: Model, effect: Effect) -> bool:
    try:
        model.with_effects(effect.source or effect.id)
    except ModelError:
        return False
    return True
