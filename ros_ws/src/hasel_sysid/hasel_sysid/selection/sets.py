"""What is chosen among: sets of effects, and the problem that can fit them."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from hasel_sysid.estimation.bounded import bounded_change
from hasel_sysid.noise import NoiseModel

EffectSet = frozenset[str]
NOTHING: EffectSet = frozenset()


@dataclass(frozen=True, eq=False)
class FittedSet:
    """A model with a set of effects, fitted to all runs.

    residual [frames]; jacobian [frames, parameters] of the predicted series, by every parameter that may still move;
    lower, upper [parameters]: by how much each may change; owners [parameters]: the effect of each, empty for the
    model's own; without: by effect, the change of the residual [frames] if it were taken out, to first order;
    plausible: whether the effects' values lie inside their ranges, and each effect does what nothing else does;
    on_edge: whether a value only just lies inside, on a bound; fit: what the problem knows it by.
    """

    effects: EffectSet
    residual: np.ndarray
    jacobian: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    owners: tuple[str, ...]
    without: Mapping[str, np.ndarray]
    plausible: bool = True
    on_edge: bool = False
    fit: Any = None

    @property
    def squares(self) -> float:
        """Sum of the squared residuals, which a fit makes least."""
        return float(self.residual @ self.residual)

    def __str__(self) -> str:
        return name_of(self.effects)


@dataclass(frozen=True, eq=False)
class Prospect:
    """What one more effect could do to a fitted set, linearised where its derivatives are known.

    residual [frames]: with the effect at some size; jacobian [frames, parameters]: there, the set's own parameters and
    then the effect's, of which there are `own`; lower, upper [parameters]: by how much they may change; looks
    [frames, n]: what the effect can look like, its size and sign left open; beside: the effects of the set; start: what
    the problem knows the place by.
    """

    effect: str
    residual: np.ndarray
    jacobian: np.ndarray
    own: int
    lower: np.ndarray
    upper: np.ndarray
    looks: np.ndarray
    beside: EffectSet
    start: Any = None

    @cached_property
    def least_residual(self) -> np.ndarray:
        """That of least squares, one bounded step on, [frames]."""
        change, _ = bounded_change(self.residual, self.jacobian, self.lower, self.upper)
        return self.residual - self.jacobian @ change


def together(of: FittedSet, added: Sequence[Prospect], dropped: Collection[str]) -> Prospect:
    """Several prospects of a set at once, and some of its effects taken out, to first order."""
    stays = np.array([owner not in dropped for owner in of.owners], dtype=bool)
    residual = of.residual + sum((of.without[effect] for effect in dropped), start=np.zeros_like(of.residual))
    residual = residual + sum((p.residual - of.residual for p in added), start=np.zeros_like(residual))
    return Prospect(
        name_of(frozenset(p.effect for p in added)),
        residual,
        np.column_stack([of.jacobian[:, stays], *(p.jacobian[:, -p.own :] for p in added)]),
        sum(p.own for p in added),
        np.concatenate([of.lower[stays], *(p.lower[-p.own :] for p in added)]),
        np.concatenate([of.upper[stays], *(p.upper[-p.own :] for p in added)]),
        np.zeros((len(residual), 0)),
        of.effects,
    )


Wanted = tuple[EffectSet, FittedSet, Sequence[Prospect]]
"""A fit that may be asked for."""
Rank = Callable[[Prospect], float]
"""How much a prospect is worth, by which the best of each effect is told."""
Look = tuple[FittedSet, Collection[str] | None]
"""A set that is looked beyond, and the effects that are wanted beside it: all of them, where that is None."""


class Sets(Protocol):
    """Sets of effects that can be looked at and fitted."""

    runs: np.ndarray
    """Number of the run of every frame, [frames]."""
    measured: np.ndarray
    """What was measured, the mean of every run removed, [frames]."""
    slack: np.ndarray
    """Errors that every set is known to make, [frames, n], such as those of the mesh; each run in its own amount."""
    swing: float
    """The largest that was measured, from the mean of its run; what no model has is in proportion to it."""

    @property
    def at_null(self) -> Collection[str]:
        """Effects that are looked at where they do nothing yet, all of them at hardly more than the cost of one."""

    def baseline(self) -> FittedSet:
        """The model without any effect."""

    def noise(self, known: Collection[FittedSet]) -> NoiseModel:
        """Of what was measured, as far as the recordings and these fits tell."""

    def prospects(
        self,
        of: FittedSet,
        wanted: Collection[str] | None,
        rank: Rank,
        most: int,
        sized: Mapping[str, FittedSet] | None = None,
    ) -> dict[str, Prospect]:
        """What every other effect (or the wanted ones) could do; `most` of them, by rank, looked at more closely.

        sized: sets in which effects have the values from which they are to be looked at.
        """

    def prospects_of_each(self, looks: Sequence[Look], rank: Rank, most: int) -> list[dict[str, Prospect]]:
        """The same beside several sets, each with the effects that are wanted there."""

    def from_other_sizes(self, of: FittedSet, prospect: Prospect) -> Prospect | None:
        """The same effect beside the same set from where other sizes lead; None where there are none."""

    def compatible(self, effects: EffectSet) -> bool:
        """Whether these effects can be in one model."""

    def foresee(self, likely: Sequence["Wanted"]) -> None:
        """Told which fits are likely to be asked for, the likeliest first: they may be begun, and others given up."""

    def fit(self, effects: EffectSet, near: FittedSet, added: Sequence[Prospect]) -> FittedSet | None:
        """Fitted in full, from where the prospects of what is new point to; None where that cannot be simulated."""

    def deepest(self, of: FittedSet) -> FittedSet:
        """The same set where its squares are least, as far as other places of its effects lead."""

    def without(self, of: FittedSet, gone: str) -> FittedSet | None:
        """The same with one effect taken out and all else left as it is; None where that cannot be simulated."""

    def out_of_time(self) -> bool:
        """Whether what has not been begun is to be left out."""


def name_of(effects: EffectSet) -> str:
    """Such as `payload + material_damping`."""
    return " + ".join(sorted(effects)) or "nothing"
