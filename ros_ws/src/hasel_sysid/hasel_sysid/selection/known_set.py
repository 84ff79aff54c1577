"""A fit of the simulator as the search sees it."""

from collections.abc import Mapping

import numpy as np
from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.context import on_edge, out_of_range
from hasel_sysid.diagnosis.step import room
from hasel_sysid.estimation import FitResult
from hasel_sysid.selection.sets import FittedSet


def known_set(fit: FitResult, candidates: Mapping[str, Effect]) -> FittedSet:
    """Of a fitted model those of its effects that are candidates; what is on a bound moves no more."""
    evaluation, model = fit.evaluation, fit.model
    own = frozenset(e.id for e in model.effects if e.id in candidates)
    owner = {
        name: effect
        for effect in own
        for name in model.parameters.keys() - model.without_effects(effect).parameters.keys()
    }
    moving = [name for name in evaluation.names if name not in fit.at_bound]
    without = {effect: np.zeros(len(evaluation.runs)) for effect in own}
    for effect in own:
        for p in candidates[effect].parameters:
            name = f"{effect}.{p.name}"
            if name in evaluation.names and not p.scan:
                slope = evaluation.jacobian[:, evaluation.names.index(name)]
                without[effect] += slope * (model.values[name] - p.null)
    return FittedSet(
        own,
        evaluation.residual,
        evaluation.by(moving).jacobian,
        *room(model, moving),
        tuple(owner.get(name, "") for name in moving),
        without,
        not any(out_of_range(effect, fit) or _is_a_double(candidates[effect], fit) for effect in own),
        any(on_edge(effect, fit) for effect in own),
        fit,
    )


def _is_a_double(effect: Effect, fit: FitResult) -> bool:
    """Whether an effect does only what free constants of the model do: such as its modulus, which is free already."""
    sizes = {f"{effect.id}.{p.name}" for p in effect.parameters if not p.scan} & set(fit.evaluation.names)
    return bool(sizes) and sizes <= set(fit.undetermined)
