"""Which other sets of effects promise to explain more, by the derivatives that are known already."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from hasel_sysid.diagnosis.trial import MOST_CHANGE, Trial, limited
from hasel_sysid.fit.bounded import bounded_change
from hasel_sysid.problem import Evaluation

_HOPEFUL = 12
"""How many effects are combined: 12 make 66 pairs, and as many again for every effect that could go."""


@dataclass(frozen=True)
class Move:
    """From one set of effects to another; squares: the sum expected there; values: where a fit begins, by name."""

    drop: tuple[str, ...]
    add: tuple[str, ...]
    squares: float
    values: dict[str, float]

    def __str__(self) -> str:
        changes = [*(f"without {effect}" for effect in self.drop), *(f"with {effect}" for effect in self.add)]
        return ", ".join(changes)


def moves(
    evaluation: Evaluation, trials: Mapping[str, Trial], removable: Sequence[str], room: int
) -> list[Move]:
    """Two effects more, one for another, or two for one: what single additions cannot reach; most promising first.

    Two effects that hide each other's trace are missed by adding one after the other, and the first of several may
    have stood in for the others. evaluation: of the model with its present effects; trials: of one more effect each, by
    its id; removable: present effects that may go; room: how many more effects there may be.
    """
    hopeful = sorted(trials, key=lambda effect: trials[effect].predicted)[:_HOPEFUL]
    pairs = [pair for pair in combinations(hopeful, 2) if _compatible(trials, pair)]
    found = []
    for drop in [(), *((effect,) for effect in removable)]:
        for add in [*((effect,) for effect in hopeful if drop), *pairs]:
            if len(add) - len(drop) <= room:
                found.append(_predicted(evaluation, [trials[effect] for effect in add], drop))
    return sorted(found, key=lambda move: move.squares)


def _compatible(trials: Mapping[str, Trial], pair: tuple[str, str]) -> bool:
    first, second = (trials[effect].start.effect.exclusive for effect in pair)
    return not first or first != second


def _predicted(evaluation: Evaluation, added: Sequence[Trial], drop: Sequence[str]) -> Move:
    """The move linearised: each added effect changes the series as in its trial, each dropped one goes to its null."""
    model, residual = evaluation.model, evaluation.residual.copy()
    gone = {
        f"{effect.id}.{p.name}": p.null
        for effect in model.effects
        if effect.id in drop
        for p in effect.parameters
    }
    columns, values, limits = [], {}, []
    short = limited(model, evaluation.names)
    for index, name in enumerate(evaluation.names):
        if name in gone:
            residual += evaluation.jacobian[:, index] * (model.values[name] - gone[name])
            continue
        moved = sum(trial.model.values[name] - model.values[name] for trial in added)
        p = model.parameters[name]
        values[name] = float(np.clip(p.value + moved, p.lower, p.upper))
        columns.append(evaluation.jacobian[:, index])
        reach = MOST_CHANGE * abs(values[name]) if short[index] else np.inf
        limits.append((max(p.lower - values[name], -reach), min(p.upper - values[name], reach)))
    for trial in added:
        residual -= evaluation.residual - trial.residual
        for index, name in enumerate(trial.names):
            if name in trial.start.values:
                p = trial.model.parameters[name]
                values[name] = p.value
                columns.append(trial.jacobian[:, index])
                limits.append((p.lower - p.value, p.upper - p.value))
    lower, upper = np.array(limits).T
    change, squares = bounded_change(residual, np.column_stack(columns), lower, upper)
    values = {name: value + step for (name, value), step in zip(values.items(), change, strict=True)}
    return Move(tuple(drop), tuple(trial.start.effect.id for trial in added), squares, values)
