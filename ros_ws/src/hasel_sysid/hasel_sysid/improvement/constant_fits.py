"""Fits of a model with one constant of its file free."""

from collections.abc import Mapping
from functools import cached_property, partial
from itertools import islice

from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model

from hasel_sysid.estimation import FitResult, fit_least_squares, is_close
from hasel_sysid.improvement.constants_looked_at import beside_what_is_close, beside_what_is_far_off
from hasel_sysid.improvement.freed_constant import is_possible
from hasel_sysid.policy import Policy
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.selection.fits_ahead import FitsAhead
from hasel_sysid.selection.held_against import NEAR


class ConstantFits:
    """Each is made once, against however many sets of effects it is held.

    given: the model to begin with, where the fitted one is far off.
    """

    def __init__(
        self, problem: Problem, fitted: Evaluation, policy: Policy, given: Model | None = None
    ) -> None:
        self._problem, self._fitted, self._policy, self._given = problem, fitted, policy, given
        self._made: dict[str, FitResult | None] = {}

    def promising(self, least: float, allowed: float) -> dict[str, FitResult]:
        """Of the constants that may leave as little as `least`, as many at once as there are processes.

        Made to its end is only what may come near the squares that are allowed, when it is made, for a model that
        describes its runs. Left out is
        what cannot be simulated, ends at what no model file may say, or there was no time for.
        """
        if is_close(self._fitted):
            begin = beside_what_is_close(self._problem, self._fitted, least, self._policy)
        else:
            begin = self._from_afar
        self._make({name: model for name, model in begin.items() if name not in self._made}, allowed)
        fits = {name: self._made[name] for name in begin}
        return {name: fit for name, fit in fits.items() if fit is not None}

    @cached_property
    def _from_afar(self) -> dict[str, Model]:
        return beside_what_is_far_off(self._problem, self._fitted, self._policy, self._given)

    def _make(self, begin: Mapping[str, Model], allowed: float) -> None:
        ahead: FitsAhead[FitResult | None] = FitsAhead(self._problem)
        fits = {name: partial(_fitted, model, name, self._policy, allowed) for name, model in begin.items()}
        for number, name in enumerate(fits):
            ahead.foresee(dict(islice(fits.items(), number, None)))
            self._made[name] = ahead.done(name, fits[name])


def _fitted(model: Model, name: str, policy: Policy, allowed: float, problem: Problem) -> FitResult | None:
    if problem.time_limit.is_over():
        return None
    try:
        fit = fit_least_squares(
            problem,
            model,
            tolerance=1e-3,
            most_evaluations=policy.effort.evaluations,
            drafts=False,
            goal=NEAR * allowed,
        )
    except HaselSimError:
        return None
    return fit if is_possible(fit.model, name) else None
