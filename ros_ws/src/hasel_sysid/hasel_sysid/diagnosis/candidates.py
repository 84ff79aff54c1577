"""Where the search for each effect starts."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from hasel_sim.effects.base import Effect, EffectParameter
from hasel_sim.effects.registry import catalogue, find_effects
from hasel_sim.errors import ModelError
from hasel_sim.model import Model

from hasel_sysid.estimation.decades import over_range


@dataclass(frozen=True)
class Start:
    """One effect at values from which to search: a signed effect at its null, a one-sided one at a typical size.

    typical: values at which the effect's signature is judged; they share the nuisances with `values`.
    """

    effect: Effect
    values: dict[str, float]
    typical: dict[str, float]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the effect's parameters in a model."""
        return tuple(self.values)

    @property
    def nulls(self) -> dict[str, float]:
        """Values of the effect's sizes at which it does nothing."""
        return {f"{self.effect.id}.{p.name}": p.null for p in self.effect.parameters if not p.scan}

    @property
    def changes_nothing(self) -> bool:
        """Whether the effect starts without effect, so that one simulation serves all that go together."""
        return bool(self.nulls) and all(self.values[name] == null for name, null in self.nulls.items())

    def without_effect(self) -> "Start":
        """The same with every size at its null; a time or a place stays."""
        return replace(self, values={**self.values, **self.nulls})


def candidate_effects(model: Model, only: tuple[str, ...] | None = None) -> list[Effect]:
    """Effects that could be added to this model, less those that do not fit it.

    only: the ones to consider; all of the catalogue and these where one is written with a + before it; default: all of
    the catalogue.
    """
    named = find_effects(tuple(name.removeprefix("+") for name in only or ()))
    every = not only or any(name.startswith("+") for name in only)
    effects = list(
        {effect.id: effect for effect in (*(catalogue().values() if every else ()), *named)}.values()
    )
    present = {effect.id for effect in model.effects}
    return [effect for effect in effects if effect.id not in present and _fits(model, effect)]


def _fits(model: Model, effect: Effect) -> bool:
    try:
        model.with_effects(effect.source or effect.id)
    except ModelError:
        return False
    return True


def is_place(p: EffectParameter) -> bool:
    """Whether a parameter that is scanned is a place, or a strain from which on something acts, and no time.

    Between two times the derivatives lead; between two places they do not: what holds a body where it hardly moves does
    nothing there, and much on either side.
    """
    return bool(p.scan) and p.unit != "s"


def starts(effect: Effect) -> list[Start]:
    """For an effect with a relaxation time two starts, a short and a long one; with a place one at every value of its
    scan; else one.
    """
    nuisance = next((p for p in effect.parameters if p.scan), None)
    if nuisance is None:
        return [_start(effect, {})]
    count, chosen = len(nuisance.scan), set(nuisance.scan)
    if not is_place(nuisance):
        chosen = {nuisance.scan[count // 4], nuisance.scan[(3 * count) // 4]}
    return [_start(effect, {nuisance.name: value}) for value in sorted(chosen)]


def decade_starts(effect: Effect, beside: Start | None = None) -> list[Start]:
    """Starts over the decades of the plausible range of the effect's first size; its other sizes are typical, and a
    time or a place is that of the start beside, else the middle of its scan.
    """
    first = next((p for p in effect.parameters if not p.scan), None)
    if first is None:
        return []
    begin = beside or _start(effect, {})
    typical = {f"{effect.id}.{p.name}": p.typical for p in effect.parameters if not p.scan}
    name = f"{effect.id}.{first.name}"
    sizes = over_range(first.null, first.typical, first.lower, first.upper)
    return [replace(begin, values={**begin.values, **typical, name: size}) for size in sizes]


def resized(start: Start, factor: float) -> Start:
    """The start with whatever is one-sided at `factor` times its size, as far as its range allows."""
    values, typical = dict(start.values), dict(start.typical)
    for p in start.effect.parameters:
        if not p.scan and not _signed(p):
            name = f"{start.effect.id}.{p.name}"
            values[name] = typical[name] = float(np.clip(factor * values[name], p.lower, p.upper))
    return replace(start, values=values, typical=typical)


def valued(effect: Effect, values: Mapping[str, float]) -> Start:
    """The effect at the values that it has in a model, by parameter name."""
    own = {name: values[name] for p in effect.parameters if (name := f"{effect.id}.{p.name}") in values}
    return Start(effect, own, dict(own))


def _start(effect: Effect, fixed: dict[str, float]) -> Start:
    values, typical = {}, {}
    for p in effect.parameters:
        name = f"{effect.id}.{p.name}"
        middle = fixed.get(p.name, p.scan[len(p.scan) // 2] if p.scan else p.typical)
        typical[name] = middle
        values[name] = p.null if _signed(p) else middle
    return Start(effect, values, typical)


def _signed(p: EffectParameter) -> bool:
    return not p.scan and p.lower < p.null - 1e-12 and p.upper > p.null + 1e-12 and np.isfinite(p.null)
