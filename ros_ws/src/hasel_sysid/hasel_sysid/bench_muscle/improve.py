"""Add what a muscle's law lacks, one effect after the other, judged on voltages that the fit did not see."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from hasel_sim.muscle.catalogue import muscle_catalogue
from hasel_sim.muscle.muscle import Muscle

from hasel_sysid.bench_muscle.adequacy import adequacy
from hasel_sysid.bench_muscle.fit import BenchFit, fit_muscle, with_errors
from hasel_sysid.bench_muscle.left_out import (
    FEWEST_LEVELS,
    Advantage,
    advantages,
    gains,
    left_out_errors,
    levels_of,
)
from hasel_sysid.bench_muscle.problem import BenchProblem
from hasel_sysid.bench_muscle.result import BenchImprovement, Stage
from hasel_sysid.bench_muscle.verdict import Finding, Trial, Verdict
from hasel_sysid.errors import SysidError

_LUCK = 0.05
"""How often, at most, chance alone should add something, over all effects that are tried."""
_MATTERS = 1.05
"""An effect that makes what is left out foretold by less than this factor better does not matter."""
_MOST_STAGES = 6

Progress = Callable[[str, float], None]


def improve_muscle(
    problem: BenchProblem,
    muscle: Muscle,
    unseen: BenchProblem | None = None,
    candidates: Sequence[str] | None = None,
    progress: Progress | None = None,
) -> BenchImprovement:
    """Compare, fit, and add effects while they foretell left-out voltages better by more than luck.

    Raises SysidError where there are too few voltages to leave any out.
    """
    count = len(levels_of(problem))
    if count < FEWEST_LEVELS:
        raise SysidError(
            f"these recordings lift at {count} voltages; expected {FEWEST_LEVELS} and more, as what is missing is "
            "judged on voltages left out: record more, or use --fit-only"
        )
    search = _Search(problem, unseen, progress or (lambda text, share: None))
    stages = [search.stage("", BenchFit(muscle, 0.0)), search.stage("", fit_muscle(problem, muscle))]
    first = adequacy(problem, stages[-1].fit.muscle)
    left = [name for name in (candidates or muscle_catalogue()) if name not in stages[-1].effects]
    trials: list[Trial] = []
    while left and len(stages) < _MOST_STAGES and not adequacy(problem, stages[-1].fit.muscle).describes:
        trials = search.trials(stages[-1].fit, left, len(stages) - 2)
        good = [trial for trial in trials if _good(trial)]
        if not good:
            break
        best = min(good, key=lambda trial: float(np.mean(np.log(np.asarray(trial.left_out) + search.floor))))
        rivals = tuple(
            each.effect
            for each in good
            if each is not best and search.gain(each.left_out, best.left_out).luck > _LUCK
        )
        stages.append(search.stage(best.effect, best.fit, rivals))
        left.remove(best.effect)
    final = adequacy(problem, stages[-1].fit.muscle)
    found = BenchImprovement(
        tuple(stages), (), final, first, tuple((s.added, *s.rivals) for s in stages if s.rivals)
    )
    findings = search.findings(found, left, {trial.effect: trial for trial in trials})
    return BenchImprovement(found.stages, findings, final, first, found.groups)


def _good(trial: Trial) -> bool:
    return trial.gain.luck < _LUCK and trial.gain.factor > _MATTERS and not trial.beyond


class _Search:
    """Tries effects on one problem."""

    def __init__(self, problem: BenchProblem, unseen: BenchProblem | None, progress: Progress) -> None:
        self.problem, self.unseen, self.progress = problem, unseen, progress
        self.floor = float(np.average(problem.noise**2, weights=problem.weights))

    def stage(self, added: str, fit: BenchFit, rivals: tuple[str, ...] = ()) -> Stage:
        """A stage with its errors."""
        unseen = self.unseen.error(fit.muscle) if self.unseen is not None else {}
        return Stage(added, fit, self.problem.error(fit.muscle), unseen, rivals)

    def trials(self, fit: BenchFit, names: Sequence[str], stage: int) -> list[Trial]:
        """Each of these effects beside what is there."""
        before = left_out_errors(self.problem, fit.muscle)
        fits, after = {}, {}
        for number, name in enumerate(names):
            self.progress(f"effect {stage + 1}: trying {name}", 1 - 0.5 ** (stage + number / len(names)))
            if self.visible(fit, name):
                fits[name] = fit_muscle(self.problem, fit.muscle.with_effects(name), _starts(name))
                after[name] = left_out_errors(self.problem, fits[name].muscle)
        every = advantages([gains(before, each, self.floor) for each in after.values()])
        return [
            Trial(name, fits[name], tuple(after[name]), gain) for name, gain in zip(fits, every, strict=True)
        ]

    def gain(self, before: np.ndarray | Sequence[float], after: np.ndarray | Sequence[float]) -> Advantage:
        """What one gains over the other on levels left out."""
        return advantages([gains(before, after, self.floor)])[0]

    def visible(self, fit: BenchFit, name: str) -> bool:
        """Whether, at its typical size, anything above the noise is left when all that is free makes up for it."""
        typical = {f"{name}.{p.name}": p.typical for p in muscle_catalogue()[name].parameters}
        world = self.problem.as_if(fit.muscle.with_effects(name).with_values(typical))
        return fit_muscle(world, fit.muscle).cost > self.floor

    def _may_hide(self, muscle: Muscle, name: str) -> bool:
        """Whether the lifts are described as well with the effect at its typical size, everything else fitted again."""
        typical = {f"{name}.{p.name}": p.typical for p in muscle_catalogue()[name].parameters}
        with_it = muscle.with_effects(name).with_values(typical)
        fixed = {key: replace(with_it.parameters[key], free=False) for key in typical}
        frozen = replace(with_it, parameters={**with_it.parameters, **fixed})
        return adequacy(self.problem, fit_muscle(self.problem, frozen).muscle).describes

    def findings(
        self, found: BenchImprovement, left: Sequence[str], trials: dict[str, Trial]
    ) -> tuple[Finding, ...]:
        """What is said of every effect."""
        rivals = {name: stage.added for stage in found.stages for name in stage.rivals}
        said = [
            Finding(stage.added, Verdict.MISSING, _sizes(stage.fit.muscle, stage.added))
            for stage in found.stages[2:]
        ]
        for name in left:
            said.append(self._finding(name, found, rivals, trials.get(name)))
        order = list(Verdict)
        return tuple(sorted(said, key=lambda each: order.index(each.verdict)))

    def _finding(
        self, name: str, found: BenchImprovement, rivals: dict[str, str], trial: Trial | None
    ) -> Finding:
        if name in rivals:
            return Finding(name, Verdict.AS_GOOD, f"these lifts cannot tell it from {rivals[name]}")
        if not self.visible(found.stages[-1].fit, name):
            return Finding(
                name,
                Verdict.UNSEEN,
                "beside what is free, its typical size would change these lifts by less than their noise",
            )
        if trial is not None and trial.beyond and trial.gain.luck < _LUCK:
            return Finding(name, Verdict.BEYOND, f"{_sizes(trial.fit.muscle, name)}; {trial.gain}")
        if not found.adequacy.describes:
            reason = "the model does not describe these lifts yet"
            return Finding(name, Verdict.NOT_JUDGED, reason if trial is None else f"{reason}; {trial.gain}")
        if self._may_hide(found.muscle, name):
            return Finding(
                name, Verdict.UNSEEN, "with its typical size what is free would describe these lifts as well"
            )
        fit = fit_muscle(self.problem, found.muscle.with_effects(name), _starts(name))
        others = tuple(bound for bound in fit.at_bound if not bound.startswith(f"{name}."))
        limited = with_errors(self.problem, replace(fit, at_bound=others))
        return Finding(name, Verdict.ABSENT, f"at most {_bounds(limited.muscle, name)}")


def _starts(name: str) -> list[dict[str, float]]:
    """Typical sizes, at every time that is to be scanned."""
    starts: list[dict[str, float]] = [{}]
    for p in muscle_catalogue()[name].parameters:
        key = f"{name}.{p.name}"
        starts = [{**start, key: value} for start in starts for value in (p.scan or (p.typical,))]
    return starts


def _sizes(muscle: Muscle, name: str) -> str:
    return ", ".join(str(p) for key, p in muscle.parameters.items() if key.startswith(f"{name}."))


def _bounds(muscle: Muscle, name: str) -> str:
    """Upper 95 % limits of the sizes of an effect that is not there."""
    said = []
    for p in muscle_catalogue()[name].parameters:
        fitted = muscle.parameters[f"{name}.{p.name}"]
        if not p.scan:
            limit = fitted.value + 1.645 * (fitted.standard_error or 0.0)
            said.append(f"{fitted.name} {limit:.2g}" + ("" if p.unit == "1" else f" {p.unit}"))
    return ", ".join(said)
