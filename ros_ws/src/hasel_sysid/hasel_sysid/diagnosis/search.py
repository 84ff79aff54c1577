"""Which effects could explain what is left: many tried roughly, few thoroughly."""

from collections.abc import Callable, Sequence

from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.candidates import Start, decade_starts, larger_starts, resized, starts
from hasel_sysid.diagnosis.trial import Trial, Trials

_ROUNDS = (9, 5)
"""How many effects go on to the second and to the third round."""
_BATCH = 8
_FAR = 2.0
"""A start that makes the sum of squares this many times worse is too far off for its promise to be believed, or not."""
_HALVINGS = 2
"""How often what starts too far off is tried again from half of its size."""
_SOME_HOPE = 0.2
"""What by its change and derivatives from far off could lower the sum of squares by less than this share is not."""
_RIVAL = 0.5
"""What could lower the sum of squares by less than this share of what the best one could is no rival to it."""
WORTH_A_STEP = 0.05
"""Half the least share of the sum of squares for which an effect is added: less is not worth another step."""

Progress = Callable[[str, float], None]


def search(
    trials: Trials, effects: Sequence[Effect], progress: Progress | None = None, decades: bool = False
) -> tuple[list[Trial], list[Trial]]:
    """The best trial of every effect, best first, and the first trial at every start.

    The first round tries every start of every effect, and from half the size what starts too far off; later rounds take
    further steps with the most promising. When the problem's time is over no more is tried.
    """
    every = [start for effect in effects for start in starts(effect)]
    usual = {id(start) for start in every}
    if decades:
        every += [start for effect in effects for start in decade_starts(effect)]
    every.sort(key=lambda start: not start.changes_nothing)
    first: list[Trial] = []
    for begin in range(0, len(every), _BATCH):
        if trials.time_is_over():
            break
        first += trials.first(every[begin : begin + _BATCH])
        if progress:
            done = min(1.0, (begin + _BATCH) / len(every))
            progress(f"tried {len(first)} of {len(every)} starts", 0.5 * done)
    if not decades:
        first += nearer(trials, every, first)
    best = _steps(trials, _best_of_each(first), progress)
    return best, [trial for trial in first if not decades or id(trial.start) in usual]


def nearer(trials: Trials, tried: Sequence[Start], found: Sequence[Trial]) -> list[Trial]:
    """Trials from half the size, or a quarter, of what could not be simulated or made the sum of squares far worse."""
    squares = trials.fitted.sum_of_squares
    every: list[Trial] = []
    for _ in range(_HALVINGS):
        done = {
            id(t.start)
            for t in found
            if t.sum_of_squares <= _FAR * squares or t.promised < _SOME_HOPE * squares
        }
        halved = [(start, resized(start, 0.5)) for start in tried if id(start) not in done]
        tried = [half for start, half in halved if half.values != start.values]
        if not tried or trials.time_is_over():
            break
        found = trials.first(tried)
        every += found
    return every


def search_from_larger(
    trials: Trials, best: Sequence[Trial], worth: float, progress: Progress | None = None
) -> list[Trial]:
    """Trials, best first, from twice the typical size of what is one-sided in effects that promise enough by `best`.

    worth: by how much an effect must promise to lower the sum of squares.
    An effect twice as large as is typical may be out of reach of Gauss-Newton steps from its typical size: a slew limit
    that the voltage just meets and one that it never meets do not look alike.
    """
    if progress:
        progress("trying larger effects", 0.8)
    effects = [trial.start.effect for trial in best if trial.promised >= worth]
    larger = [start for effect in effects for start in larger_starts(effect)]
    first = [] if not larger or trials.time_is_over() else trials.first(larger)
    return _steps(trials, _best_of_each(first)) if first else []


def _steps(trials: Trials, best: list[Trial], progress: Progress | None = None) -> list[Trial]:
    """Further steps with the most promising trials; all of them, best first."""
    squares = trials.fitted.sum_of_squares
    for number, keep in enumerate(_ROUNDS):
        hopeful = [t for t in best if _has_hope(t, best, squares)]
        going_on = [
            t
            for i, t in enumerate(hopeful)
            if i < keep or (number == 0 and t.sum_of_squares > _FAR * squares)
        ]
        if not going_on or trials.time_is_over():
            break
        staying = [t for t in best if t not in going_on]
        best = sorted(trials.further(going_on) + staying, key=_promise)
        if progress:
            progress(f"round {number + 2}: {best[0].start.effect.id} promises most", 0.5 + 0.1 * (number + 1))
    return best


def _has_hope(trial: Trial, best: Sequence[Trial], squares: float) -> bool:
    """Whether another step may matter: the effect could remove enough, and not much less than the best one."""
    most = max(squares - t.predicted for t in best)
    return trial.promised >= max(_RIVAL * most, WORTH_A_STEP * squares)


def _promise(trial: Trial) -> float:
    return trial.predicted


def _best_of_each(trials: Sequence[Trial]) -> list[Trial]:
    best: dict[str, Trial] = {}
    for trial in sorted(trials, key=_promise):
        best.setdefault(trial.start.effect.id, trial)
    return list(best.values())
