# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What an effect of the muscle on its bench states, the places where one can act, and the catalogue of all."""

from dataclasses import dataclass
from functools import cache
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
from hasel_common.names import nearest_name

from hasel_sim.effects.base import EffectParameter
from hasel_sim.effects.registry import kinds_in
from hasel_sim.errors import ModelError
from hasel_sim.muscle import effects
from hasel_sim.muscle.pouch import Pouch


@dataclass(frozen=True)
class Held:
    """A pouch in balance at n instants: half angle [rad], force along the muscle [N] and at rest [N], all [n]."""

    pouch: Pouch
    angle: np.ndarray
    force: np.ndarray
    rest_force: np.ndarray


class MuscleEffect:
    """Base of all effects of the bench. It holds no state; its values come as `p`, one attribute per parameter.

    At the parameters' null values every method below returns what it is given, or zero.
    """

    id: ClassVar[str]
    physics: ClassVar[str]
    equation: ClassVar[str]
    parameters: ClassVar[tuple[EffectParameter, ...]]
    signature: ClassVar[str] = ""
    citation: ClassVar[str] = ""
    in_time: ClassVar[bool] = False
    """Whether it needs the history of the voltage, and so has no place in a law that knows the present one only."""
    exclusive: ClassVar[str] = ""
    """As of a body's effects: those with the same non-empty word do the same thing."""
    source: ClassVar[str | None] = None
    """A user's own effect says where it comes from; of a muscle there are none."""

    def pouches(self, pouch: Pouch, p: SimpleNamespace) -> list[tuple[float, Pouch]]:
        """What the muscle's pouches are like: shares [1] that add up to 1, each with its pouch."""
        return [(1.0, pouch)]

    def electrodes(self, time: np.ndarray, voltage: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Voltage [V] [n] that pulls, from the one applied at times [s] [n]."""
        return voltage

    def opposing(self, strain: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Force [N] with which the muscle itself resists a contraction by its rest length [1]; never falling."""
        return np.zeros_like(strain)

    def give(self, held: Held, p: SimpleNamespace) -> np.ndarray:
        """By how much more than at rest something stretches, per pouch [m] [n]."""
        return np.zeros_like(held.angle)

    def follow(self, time: np.ndarray, contraction: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction [m] [n] that follows in time from the one in balance."""
        return contraction

    def before(self, time: np.ndarray, contraction: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """The inverse of `follow`: what is in balance when the contraction [m] [n] is held by the bench."""
        return contraction


@cache
def muscle_catalogue() -> dict[str, MuscleEffect]:
    """The effects by id, in alphabetical order."""
    return {kind.id: kind() for kind in kinds_in(effects, MuscleEffect)}


def find_muscle_effects(names: tuple[str, ...]) -> tuple[MuscleEffect, ...]:
    """Effects by id. Raises ModelError with the nearest known one."""
    known = muscle_catalogue()
    for name in names:
        if name not in known:
            raise ModelError(
                f"unknown effect of a muscle '{name}'; {nearest_name(name, known)}: correct the name"
            )
    return tuple(known[name] for name in names)
