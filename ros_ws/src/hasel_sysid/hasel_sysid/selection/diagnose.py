"""Diagnosis: which one effect, if any, explains what a fitted model leaves; no data but the fitted runs are used."""

from collections.abc import Sequence
from dataclasses import replace

from hasel_sysid.diagnosis import Diagnosis, Verdict
from hasel_sysid.diagnosis.adequacy import adequacy
from hasel_sysid.diagnosis.candidates import candidate_effects
from hasel_sysid.estimation import FitResult, in_step, is_close
from hasel_sysid.estimation.refinement import changes_by_refinement
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Problem
from hasel_sysid.selection.choice import choose
from hasel_sysid.selection.search import Progress, search
from hasel_sysid.selection.simulated_sets import SimulatedSets
from hasel_sysid.selection.verdicts import diagnosis


def diagnose(
    problem: Problem, fit: FitResult, only: Sequence[str] | None = None, progress: Progress | None = None
) -> Diagnosis:
    """Rank every effect of the catalogue (or the named ones) as an explanation of what `fit` leaves.

    The search of `improve`, among sets of one effect. Raises ModelError for an unknown effect.
    """
    policy = replace(POLICY, most_effects=1)
    effects = candidate_effects(fit.model, tuple(only) if only else None)
    changes = changes_by_refinement(problem, fit.evaluation)
    near = in_step(fit.evaluation)
    given = None if is_close(fit.evaluation) else fit.model
    sets = SimulatedSets(problem, fit, effects, list(changes.values()) if near else (), given)
    found = search(sets, policy, progress)
    choice = choose(found, policy)
    said = diagnosis(sets, found, choice, changes)
    named = said.best is not None and said.best.verdict is Verdict.MISSING
    described = adequacy((said.best.fit if named else fit).evaluation, said.noise)
    return replace(said.seen_beside(described.adequate), adequacy=described)
