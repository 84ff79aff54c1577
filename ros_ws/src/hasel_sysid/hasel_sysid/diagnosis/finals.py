"""Full fits of the few most promising effects, on the model itself, and the noise that they reveal."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from hasel_sim.errors import SimulationError

from hasel_sysid.diagnosis.context import expected_squares, plausible
from hasel_sysid.diagnosis.learned_residual import regressors, unexplained_by
from hasel_sysid.diagnosis.search import WORTH_A_STEP
from hasel_sysid.diagnosis.trial import Trial
from hasel_sysid.fit import FitResult, fit_least_squares
from hasel_sysid.noise import NoiseModel, estimate_noise
from hasel_sysid.noise_sources.above_the_band import noise_above_the_band
from hasel_sysid.noise_sources.between_periods import noise_between_periods
from hasel_sysid.problem import Problem

_FINALISTS, _MOST_FITS = 3, 6
"""How many are fitted in any case, and at most."""
_BRIEF = 8
"""Evaluations that a finalist is given."""
_NEXT = 0.01
"""What comes within this share of the baseline's sum of squares of the best fit may win for having fewer values."""
_CLOSE = 0.05
"""A trial within this share of the baseline's sum of squares of the best one is refitted in full."""
_MUCH, _MOST, _WORTH = 0.3, 0.9, 0.25
"""An excess of this share of the noise's sum of squares is much; this share of the excess is most of it; a trial whose
next step would remove this share may be worth a full fit."""
_COULD = 0.3
"""What could never remove this share of the excess, by its promise, would not be accepted and needs no full fit."""
_QUIETER = 0.8
"""A bound this much quieter than the residual shows that the residual is not noise."""
DISCREPANCY = 0.005
"""Share of the largest swing, as rms, by which no model is exact: of 0.3 the 0.0015 that the mesh is converged to."""

Progress = Callable[[str, float], None]


def full_fits(
    problem: Problem,
    fit: FitResult,
    best: list[Trial],
    larger: Callable[[float], list[Trial]],
    progress: Progress | None,
) -> dict[str, FitResult]:
    """Full fits of the few most promising effects, on the model itself; of some more where those explain too little.

    larger: trials that start from larger sizes, of effects that promise to lower the sum of squares by so much, asked
    for where the other ones do not lead to an explanation.
    """
    squares = fit.evaluation.sum_of_squares
    close = [t for t in best if t.predicted <= best[0].predicted + _CLOSE * squares]
    chosen = close[:1] + [t for t in close[1:_FINALISTS] if t.promised >= WORTH_A_STEP * squares]
    finals = _refitted(problem, fit, chosen, progress)
    rest = [trial for trial in best if trial not in chosen]
    finals = _while_needed(problem, fit, finals, rest, _MOST_FITS - len(finals), progress)
    worth = _least_drop_worth_larger_sizes(problem, fit, finals)
    if np.isfinite(worth):
        finals = _while_needed(problem, fit, finals, larger(worth), _FINALISTS, progress)
    return finals | _finished(problem, fit, finals)


def _while_needed(
    problem: Problem,
    fit: FitResult,
    finals: dict[str, FitResult],
    trials: list[Trial],
    most: int,
    progress: Progress | None,
) -> dict[str, FitResult]:
    """`finals` with up to `most` more full fits, in the order of `trials`, while they explain too little."""
    squares = fit.evaluation.sum_of_squares
    next_step, promise = _least_drops_worth_a_fit(problem, fit, finals)
    for trial in trials:
        worth = squares - trial.predicted > next_step and trial.promised > promise
        if most > 0 and worth and not _known(trial, finals) and not problem.time_limit.is_over():
            finals = _better_of(finals, _refitted(problem, fit, [trial], progress))
            next_step, promise = _least_drops_worth_a_fit(problem, fit, finals)
            most -= 1
    return finals


def _better_of(finals: dict[str, FitResult], more: dict[str, FitResult]) -> dict[str, FitResult]:
    better = {
        effect: final
        for effect, final in more.items()
        if effect not in finals or final.evaluation.sum_of_squares < finals[effect].evaluation.sum_of_squares
    }
    return finals | better


def _refitted(
    problem: Problem, fit: FitResult, trials: list[Trial], progress: Progress | None
) -> dict[str, FitResult]:
    finals = {}
    for number, trial in enumerate(trials):
        if number > 0 and problem.time_limit.is_over():
            break
        effect = trial.start.effect
        model = fit.model.with_effects(effect.source or effect.id).with_values(trial.step)
        if progress:
            progress(f"refitting with {effect.id}", 0.7 + 0.3 * number / _FINALISTS)
        try:
            finals[effect.id] = fit_least_squares(
                problem, model, tolerance=1e-3, most_evaluations=_BRIEF, drafts=False
            )
        except SimulationError:
            continue
    return finals


def _finished(problem: Problem, fit: FitResult, finals: dict[str, FitResult]) -> dict[str, FitResult]:
    """The best of the plausible fits and what comes close to it, where broken off before they had converged."""
    squares = {effect: final.evaluation.sum_of_squares for effect, final in plausible(finals, fit).items()}
    close = min(squares.values(), default=0.0) + _NEXT * fit.evaluation.sum_of_squares
    return {
        effect: fit_least_squares(problem, finals[effect].model, tolerance=1e-3, drafts=False)
        for effect, reached in squares.items()
        if reached <= close and finals[effect].iterations >= _BRIEF and not problem.time_limit.is_over()
    }


def _least_drops_worth_a_fit(
    problem: Problem, fit: FitResult, finals: dict[str, FitResult]
) -> tuple[float, float]:
    """By how much a trial must lower the sum of squares, by its next step and by its promise; infinite: no more fits.

    More are needed while no plausible one removes most of an error well above the noise: a trial's few steps may have
    got stuck where a full fit does not, and the best may be refuted by runs left out. Where one does but stays well
    above the noise, only what promises nearly as much may take its place.
    """
    base, lowest, floor = _squares(problem, fit, finals)
    excess, removed = base - floor, base - lowest
    if removed < _MOST * excess:
        needed, promise = excess > _MUCH * floor, _COULD * excess
    else:
        needed, promise = lowest - floor > _MUCH * floor, _MOST * removed
    return (_WORTH * excess, promise) if needed else (np.inf, np.inf)


def _least_drop_worth_larger_sizes(problem: Problem, fit: FitResult, finals: dict[str, FitResult]) -> float:
    """By how much an effect must promise to lower the sum of squares for a larger size of it to be tried; or infinite.

    No less than the best fit so far does, or nearly: what is to take its place must do better. Infinite where that one
    comes near the noise.
    """
    base, lowest, floor = _squares(problem, fit, finals)
    if lowest - floor <= _MUCH * floor:
        return float("inf")
    return max(_WORTH * (base - floor), _MOST * (base - lowest))


def _squares(problem: Problem, fit: FitResult, finals: dict[str, FitResult]) -> tuple[float, float, float]:
    """Sum of squares of the fit, of the best plausible one with an effect, and expected of noise alone."""
    base = fit.evaluation
    floor = expected_squares(base.jacobian, allowed_noise(problem, noise_of(problem, fit, finals)), base.runs)
    squares = [final.evaluation.sum_of_squares for final in plausible(finals, fit).values()]
    return base.sum_of_squares, min([base.sum_of_squares, *squares]), floor


def _known(trial: Trial, finals: dict[str, FitResult]) -> bool:
    """Whether an effect that does the same is fitted already, or the effect itself at least as well as promised."""
    effect = trial.start.effect
    if effect.id in finals:
        return finals[effect.id].evaluation.sum_of_squares <= trial.predicted
    fitted = {effect.exclusive for final in finals.values() for effect in final.model.effects}
    return bool(effect.exclusive) and effect.exclusive in fitted


def noise_of(problem: Problem, fit: FitResult, finals: dict[str, FitResult]) -> NoiseModel:
    """The noise of the runs: as measured or given, else the lowest of the upper bounds that the recordings give.

    Upper bounds are what neither the best model nor a learned model of its residual explains, what differs between
    periods of the drive, and what is faster than the body; the first is kept unless another is clearly lower.
    """
    if problem.measured_noise is not None:
        return problem.measured_noise
    best = min([fit, *finals.values()], key=lambda result: result.evaluation.sum_of_squares)
    evaluation = best.evaluation
    columns = np.column_stack([evaluation.jacobian, regressors(evaluation)])
    left = unexplained_by(columns, evaluation.residual)
    whole = estimate_noise(left, evaluation.runs, columns, "what the best model and a learned residual leave")
    others = [noise_between_periods(evaluation), noise_above_the_band(evaluation)]
    bounds = [b for b in others if b and b.standard_deviation < _QUIETER * whole.standard_deviation]
    lowest = min(bounds, key=lambda bound: bound.standard_deviation, default=whole)
    return replace(lowest, upper_bound=True)


def allowed_noise(problem: Problem, noise: NoiseModel) -> NoiseModel:
    """What a right model may leave: the noise and the one discrepancy that is allowed for.

    An upper bound of the noise, which holds some of it already, is only raised where it lies below that discrepancy.
    """
    discrepancy = DISCREPANCY * problem.largest_swing
    if not noise.upper_bound:
        return noise.with_discrepancy(discrepancy)
    missing = discrepancy**2 - noise.standard_deviation**2
    return noise.with_discrepancy(float(np.sqrt(missing))) if missing > 0 else noise
