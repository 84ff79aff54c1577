"""Whether a diagnosis gives reason to add an effect."""

from collections.abc import Sequence
from dataclasses import dataclass

from hasel_sysid.diagnosis import Diagnosis, Finding, Verdict
from hasel_sysid.diagnosis.context import SIGNIFICANT, on_own_bound
from hasel_sysid.diagnosis.explained import EXPLAINED
from hasel_sysid.improve.conclusion import near_noise
from hasel_sysid.improve.result import Stage

LEAST_GAIN = 0.1
"""An effect must lower the sum of squares by this share; what another mesh leaves is less."""
_NEARLY = 0.8
"""Finer numerics that explain this share of what the best effect does come before any effect."""


@dataclass(frozen=True)
class Decision:
    """accepted: what to add, or None and the reason; negligible: whether what could be added would hardly matter;
    none_alone: whether something is missing, but no single effect.
    """

    accepted: Finding | None
    reason: str = ""
    negligible: bool = False
    none_alone: bool = False


def decide(stage: Stage, found: Diagnosis) -> Decision:
    """What to do after a stage whose left-over error has been diagnosed."""
    near = near_noise(stage.fit, found)
    if found.p_value >= SIGNIFICANT and not near:
        return Decision(
            None, f"None of the listed effects stands out from what is left, {_not_noise(stage, found)}."
        )
    if found.p_value >= SIGNIFICANT:
        what = "What is left is noise" if stage.effects else "Nothing is missing"
        return Decision(None, f"{what}: noise alone looks like this in {found.p_value:.0%} of cases.")
    candidates = [f for f in found.findings if f.verdict is Verdict.MISSING and f.fit is not None]
    if trifle := _trifle(stage, found, candidates):
        return _left_alone(trifle, stage, found)
    squares = 1 - (1 - found.explained) ** 2
    enough = max(0.5, _NEARLY * squares)
    numerics = {name: share for name, share in found.suspects.items() if share > enough}
    if numerics:
        name = max(numerics, key=numerics.get)
        what = f"The {name.replace('_', ' ')} explains {numerics[name]:.0%} of what is left"
        return Decision(None, f"{what}: refine it first.")
    if not candidates:
        return Decision(None, _none_convinces(found), none_alone=True)
    if trifle := _trifle(stage, found, candidates, _known_to_be_numerical(found)):
        return _left_alone(trifle, stage, found)
    return Decision(candidates[0])


def _left_alone(trifle: str, stage: Stage, found: Diagnosis) -> Decision:
    if near_noise(stage.fit, found):
        return Decision(None, f"Nothing that matters is missing: {trifle}.", negligible=True)
    return Decision(None, f"{trifle}; what is left is {_not_noise(stage, found)}.")


def _known_to_be_numerical(found: Diagnosis) -> float:
    """Share of the squared error that finer numerics would remove: of that no effect is accused."""
    return max(found.suspects.values(), default=0.0) * found.context.excess / found.context.base


def _trifle(stage: Stage, found: Diagnosis, candidates: Sequence[Finding], numerical: float = 0.0) -> str:
    """Why what is missing does not matter; empty if it does. numerical: share of the squared error."""
    if not candidates:
        times = stage.fit.mean_absolute_error / found.noise.mean_absolute
        reason = f"the error is {times:.2f} times the noise's, and no effect accounts for it"
        return reason if near_noise(stage.fit, found) else ""
    squares = stage.fit.evaluation.sum_of_squares
    most = max(1 - f.fit.evaluation.sum_of_squares / squares for f in candidates)
    if most - numerical >= LEAST_GAIN:
        return ""
    of_it = f", of which finer numerics would remove {numerical:.1%}" if numerical > 0 else ""
    return f"{candidates[0].effect} makes {most:.1%} of the squared error{of_it}"


def _not_noise(stage: Stage, found: Diagnosis) -> str:
    times = stage.fit.mean_absolute_error / found.noise.mean_absolute
    return f"{times:.3g} times the error that is allowed for: the model does not describe these runs yet"


def _none_convinces(found: Diagnosis) -> str:
    """Why no effect is accepted although something is missing."""
    learned = f"a learned model of the residual {found.ceiling:.0%}"
    if found.explained < EXPLAINED:
        return (
            f"None of the listed effects explains what is left: the best removes {found.explained:.0%} of the error "
            f"above the noise, {learned}."
        )
    best = min(
        (finding for finding in found.findings if finding.fit is not None),
        key=lambda finding: finding.fit.evaluation.sum_of_squares,
    )
    at_edge = on_own_bound(best.effect, best.fit)
    refuted = "only at the edge of its range" if at_edge else "foretells runs left out of the fit worse"
    return (
        f"None of the listed effects is a plausible explanation of what is left: {best.effect} removes "
        f"{found.explained:.0%} of the error above the noise, but {refuted}; {learned}."
    )
