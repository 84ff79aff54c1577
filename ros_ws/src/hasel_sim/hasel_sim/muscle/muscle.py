# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A Peano-HASEL muscle: pouches in series, what acts on them, and its numbers; changed only by copying."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import SimpleNamespace

import numpy as np
from hasel_common.names import nearest_name

from hasel_sim.errors import ModelError
from hasel_sim.muscle.effect import Held, MuscleEffect, find_muscle_effects
from hasel_sim.muscle.pouch import Pouch, bisect
from hasel_sim.parameter import Parameter, Parametrised, parameters_of, values_of

POUCH = "pouch."
"""How the names of the pouch's constants begin that are free, such as `pouch.fill`."""


@dataclass(frozen=True)
class Muscle(Parametrised):
    """count: pouches in series; mass [kg]: of the muscle, half of which hangs from its middle beside the load.

    parameters: what may be fitted, `pouch.<constant>` and `<effect>.<parameter>`.
    """

    name: str
    pouch: Pouch
    count: int
    mass: float = 0.0
    effects: tuple[MuscleEffect, ...] = ()
    parameters: dict[str, Parameter] = field(default_factory=dict)

    def parameter(self, name: str) -> Parameter:
        """One parameter. Raises ModelError for an unknown name."""
        if name not in self.parameters:
            raise ModelError(
                f"'{name}' is no parameter of muscle '{self.name}'; {nearest_name(name, self.parameters)}"
            )
        return self.parameters[name]

    def is_amplitude(self, name: str) -> bool:
        """Whether a parameter is a contraction at one voltage: a law has none."""
        return False

    def is_onset(self, name: str) -> bool:
        """Whether a parameter is a voltage up to which nothing contracts: the law says itself which one that is."""
        return False

    def with_effects(self, *names: str) -> "Muscle":
        """A copy with further effects, at their null values. Raises ModelError for one unknown or already there."""
        parameters = dict(self.parameters)
        present = {effect.id for effect in self.effects}
        effects = find_muscle_effects(names)
        for effect in effects:
            if effect.id in present:
                raise ModelError(
                    f"effect '{effect.id}' is in muscle '{self.name}' already: remove one of the two"
                )
            parameters |= parameters_of(effect)
        return replace(self, effects=(*self.effects, *effects), parameters=parameters)

    def without_effects(self, *names: str) -> "Muscle":
        """A copy without some effects and their parameters."""
        gone = tuple(f"{name}." for name in names)
        return replace(
            self,
            effects=tuple(effect for effect in self.effects if effect.id not in names),
            parameters={n: p for n, p in self.parameters.items() if not (gone and n.startswith(gone))},
        )

    def contraction(
        self,
        time: np.ndarray,
        voltage: np.ndarray,
        load: np.ndarray,
        rest_load: float | None = None,
        wanted: np.ndarray | None = None,
    ) -> np.ndarray:
        """Contraction [m] under hanging loads [N] [n] at voltages [V] [n], each held from its time [s] to the next.

        rest_load: load [N] at which the contraction was called 0 (default: the first); wanted [n]: at which of the
        times it is asked for (default: at all).
        """
        rest = np.full(np.shape(load), load[0] if rest_load is None else rest_load)
        pulling = self._pulling(time, voltage)
        here = np.ones(len(time), dtype=bool) if wanted is None else wanted
        if not any(type(effect).follow is not MuscleEffect.follow for effect in self.effects):
            return self.balanced(pulling[here], load[here], rest[here])
        x = self.balanced(pulling, load, rest)
        for effect, p in self._acting():
            x = effect.follow(time, x, p)
        return x[here]

    def force(
        self,
        time: np.ndarray,
        voltage: np.ndarray,
        contraction: np.ndarray,
        rest_load: float = 0.0,
        wanted: np.ndarray | None = None,
    ) -> np.ndarray:
        """Force [N] of the muscle held at contractions [m] [n], where it is wanted [n]; 0 where it hangs slack."""
        for effect, p in reversed(self._acting()):
            contraction = effect.before(time, contraction, p)
        table = np.stack([np.abs(self._pulling(time, voltage)), contraction], axis=1)
        rows, back = np.unique(table if wanted is None else table[wanted], axis=0, return_inverse=True)
        volts, aim = rows.T
        rest = np.full(len(rows), rest_load)
        high = np.maximum(self._strongest(volts), 1e-12)
        found = bisect(lambda load: aim - self.balanced(volts, load, rest), np.zeros(len(rows)), high)
        return found[back.ravel()]

    def _acting(self) -> list[tuple[MuscleEffect, SimpleNamespace]]:
        return [(effect, values_of(effect, self.values)) for effect in self.effects]

    def _pulling(self, time: np.ndarray, voltage: np.ndarray) -> np.ndarray:
        for effect, p in self._acting():
            voltage = effect.electrodes(time, voltage, p)
        return voltage

    @cached_property
    def populations(self) -> list[tuple[float, Pouch]]:
        """Shares [1] of the pouches, and what these are like with the values of the parameters."""
        freed = {
            name.removeprefix(POUCH): p.value for name, p in self.parameters.items() if name.startswith(POUCH)
        }
        found = [(1.0, replace(self.pouch, **freed))]
        for effect, p in self._acting():
            found = [
                (share * part, kind) for share, pouch in found for part, kind in effect.pouches(pouch, p)
            ]
        return found

    def balanced(self, voltage: np.ndarray, load: np.ndarray, rest_load: np.ndarray) -> np.ndarray:
        """Contraction [m] in balance; each pouch has its share of what opposes."""
        table = np.stack([np.abs(voltage), load, rest_load], axis=1)
        rows, back = np.unique(table, axis=0, return_inverse=True)
        volts, force, rest = rows.T
        weight = 0.5 * self.mass * 9.81
        x = np.zeros(len(rows))
        acting = self._acting()
        for share, pouch in self.populations:
            angle = _angle(pouch, volts, force + weight, acting)
            held = Held(pouch, angle, force + weight, rest + weight)
            one = pouch.contraction(angle)
            for effect, p in acting:
                one = one - effect.give(held, p)
            x += share * one
        return self.count * x[back.ravel()]

    def onset(self, load: float) -> float:
        """Voltage [V] from which the strongest of the pouches, still at its full length, lifts a load [N]."""
        return float(np.sqrt((load + 0.5 * self.mass * 9.81) / self._strongest(np.array([1.0]))[0]))

    def _strongest(self, voltage: np.ndarray) -> np.ndarray:
        """No pouch holds more [N] than the strongest one at rest."""
        return np.max(
            [
                pouch.force(voltage, np.full_like(voltage, pouch.relaxed_angle))
                for _, pouch in self.populations
            ],
            axis=0,
        )

    @property
    def rest_length(self) -> float:
        """Length between the outer seals [m] without voltage."""
        return self.count * self.populations[0][1].relaxed_length


def _angle(
    pouch: Pouch,
    voltage: np.ndarray,
    load: np.ndarray,
    acting: Sequence[tuple[MuscleEffect, SimpleNamespace]],
) -> np.ndarray:
    def opposing(angle: np.ndarray) -> np.ndarray:
        strain = pouch.contraction(angle) / pouch.relaxed_length
        return sum((effect.opposing(strain, p) for effect, p in acting), np.zeros_like(strain))

    free = pouch.angle_under_load(voltage, load)
    if not np.any(opposing(free)):
        return free

    def surplus(angle: np.ndarray) -> np.ndarray:
        return load + opposing(angle) - pouch.force(voltage, angle)

    return bisect(surplus, np.full(np.shape(load), pouch.relaxed_angle), free)
