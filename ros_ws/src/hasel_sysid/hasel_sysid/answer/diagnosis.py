# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is said of every effect, and of all of them; how it prints and goes into JSON."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

from hasel_sysid.estimation.fit import FittedModel
from hasel_sysid.model_checking import GoodnessOfFit
from hasel_sysid.noise import NoiseModel
from hasel_sysid.policy import POLICY


class Verdict(str, Enum):
    """The five things that can be said of an effect, and that nothing can be said: while the model describes no run, or
    because there was no time to try it.
    """

    MISSING = "missing"
    MISSING_IF_SIZE_MATTERS = "missing if its size matters"
    ABSENT = "absent"
    INCONCLUSIVE = "inconclusive"
    CANNOT_BE_SEEN = "cannot be seen"
    NOT_JUDGED = "not judged"
    NOT_TRIED = "not tried"


@dataclass(frozen=True)
class Finding:
    """What is said of one effect.

    probability: that what is missing are listed effects alone, this one among them; it is nil where they leave more
    than noise can. expected: its values in SI units (name: value, standard error); error_removed: share of the mean
    |Δ sin θ| above the noise that it explains, 0 to 1; swallowed: share of its signature that the fitted parameters
    imitate; visible_above: the smallest size that these recordings would have shown, in the unit of its first
    parameter; source: where a user's own effect comes from; beside: other effects without which it would not be
    seen; plausible: lowest and highest value of its first parameter; null: the one at which it does nothing;
    winner: the effect that is in the model where absence is judged, itself without it; leading: the one of its
    values that does most, or None.
    """

    effect: str
    verdict: Verdict
    probability: float
    error_removed: float
    expected: dict[str, tuple[float, float]]
    units: dict[str, str]
    swallowed: float
    visible_above: float
    fit: FittedModel | None = None
    source: str | None = None
    beside: tuple[str, ...] = ()
    plausible: tuple[float, float] = (-math.inf, math.inf)
    null: float = 0.0
    winner: str | None = None
    leading: str | None = None

    @property
    def is_plausible(self) -> bool:
        """Whether the estimate of its size lies within the plausible range."""
        first = next(iter(self.expected.values()), None)
        return first is None or self.plausible[0] <= first[0] <= self.plausible[1]

    def _no_size_shows(self, unit: str) -> str:
        """That no plausible size would show: a threshold beyond the plausible range is no number to tell."""
        largest = max((abs(bound - self.null) for bound in self.plausible), default=math.inf)
        reach = f" (up to {largest:.2g}{unit})" if math.isfinite(largest) else ""
        return f"no plausible size{reach} would show in these recordings"

    def __str__(self) -> str:
        first = self.leading or next(iter(self.expected), None)
        unit = "" if first is None or self.units[first] == "1" else f" {self.units[first]}"
        value = "" if first is None else f" of {self.expected[first][0]:.3g}{unit}"
        if not self.is_plausible:
            value = " beyond its plausible range"
        share = f"{self.error_removed:.0%} of the error above the noise"
        if self.beside:
            return f"{self.effect} is missing beside {' and '.join(self.beside)}: together they explain most."
        if self.verdict is Verdict.MISSING:
            if self.probability > 0.5:
                what = f"is missing (probability {self.probability:.0%})"
            else:
                alone = f"probability that it is this one, alone: {self.probability:.0%}"
                what = f"or an effect that looks like it is missing ({alone})"
            return f"{self.effect} {what}: a size{value} removes {share}."
        if self.verdict is Verdict.MISSING_IF_SIZE_MATTERS:
            if self.error_removed > 0.5:
                return f"{self.effect} could be what is missing: it would remove {share}."
            return f"{self.effect} may be there with a size{value}, but removes only {share}."
        if self.verdict is Verdict.NOT_JUDGED:
            return f"{self.effect} is not judged: the model does not describe these runs yet."
        if self.verdict is Verdict.NOT_TRIED:
            return f"{self.effect} was not tried: the time was over."
        limit = f"{self.visible_above:.2g}{unit}"
        if self.verdict is Verdict.ABSENT:
            seen = f"{self.effect} is absent: above {limit} it would have been seen"
            if self.winner is None or self.error_removed < POLICY.matters:
                return f"{seen}."
            alone = f"without {self.winner} it would imitate {self.error_removed:.0%} of what that explains"
            return f"{seen} beside {self.winner}; {alone}."
        if self.verdict is Verdict.INCONCLUSIVE:
            if not math.isfinite(self.visible_above):
                return f"{self.effect} is undecided: it could not be simulated on these recordings."
            return f"{self.effect} is undecided: these recordings would show it only above {limit}."
        if self.swallowed > POLICY.matters:
            imitated = f"the fitted parameters imitate {self.swallowed:.0%} of it, and of what is left "
        else:
            imitated = ""
        return f"{self.effect} cannot be seen: {imitated}{self._no_size_shows(unit)}."

    __repr__ = __str__


_IN_ITS_PLACE = {Verdict.MISSING: Verdict.MISSING_IF_SIZE_MATTERS}
_NEEDS_A_MODEL = (Verdict.ABSENT, Verdict.INCONCLUSIVE, Verdict.CANNOT_BE_SEEN)


def said_beside(finding: Finding, adequate: bool, added: Sequence[str] | None) -> Finding:
    """What is said of an effect beside a model that describes its runs or not, and to which these were added."""
    if added and finding.effect in added:
        others = tuple(effect for effect in added if effect != finding.effect)
        return replace(finding, verdict=Verdict.MISSING, beside=others)
    if added is not None and finding.verdict is Verdict.MISSING:
        return replace(finding, verdict=Verdict.MISSING_IF_SIZE_MATTERS)
    if not adequate and finding.verdict in _NEEDS_A_MODEL:
        return replace(finding, verdict=Verdict.NOT_JUDGED)
    return finding


@dataclass(frozen=True)
class Diagnosis:
    """What is said of all of them.

    findings: most probable first; groups: effects that these recordings cannot tell apart; noise: what a right model
    may leave, with what is allowed for discrepancy; measured: the noise alone; p_value: chance that noise alone makes
    the best effect look this good; explained: share of the error above the noise that it removes; ceiling: share of the
    squared error above the noise that a saturated model would remove; probability_none: that it is none of the listed
    effects, or not they alone; suspects: share that finer numerics would remove, by name; fit: the model that was
    diagnosed; winner: the one effect that could be added, None where there is none; goodness: of the model with it.
    """

    findings: list[Finding]
    groups: list[tuple[str, ...]]
    noise: NoiseModel
    measured: NoiseModel
    p_value: float
    explained: float
    ceiling: float
    probability_none: float
    suspects: dict[str, float]
    fit: FittedModel
    winner: str | None = None
    goodness: GoodnessOfFit | None = None

    @property
    def best(self) -> Finding | None:
        """The one effect that could be added: first of the ranking, and not refuted; None where there is none."""
        return None if self.winner is None else self.finding(self.winner)

    @property
    def not_tried(self) -> list[str]:
        """Effects for which there was no time."""
        return [finding.effect for finding in self.findings if finding.verdict is Verdict.NOT_TRIED]

    def seen_beside(self, adequate: bool, added: Sequence[str] | None = None) -> "Diagnosis":
        """The diagnosis as it may be said of a model that describes its runs, or does not.

        Where it does not, no effect is absent, undecided or invisible: nobody can know yet. added: what turned out
        to be missing in the end, which may be more or other than what looked best at first, or nothing; None where
        nobody asked.
        """
        return replace(self, findings=[said_beside(finding, adequate, added) for finding in self.findings])

    def of_no_effect(self) -> "Diagnosis":
        """The diagnosis where it turned out that what is wrong is no effect: some could at most stand in its place."""
        findings = [
            replace(f, probability=0.0, verdict=_IN_ITS_PLACE.get(f.verdict, f.verdict))
            for f in self.findings
        ]
        return replace(self, findings=findings, probability_none=1.0, winner=None)

    def finding(self, effect: str) -> Finding:
        """What is said of one effect."""
        return next(finding for finding in self.findings if finding.effect == effect)

    @property
    def groups_in_question(self) -> list[tuple[str, ...]]:
        """The groups of which a member may be missing; of the others it does not matter who is who."""
        ruled_out = {finding.effect for finding in self.findings if finding.verdict in _NEEDS_A_MODEL}
        return [group for group in self.groups if not set(group) <= ruled_out]

    def __str__(self) -> str:
        lines = [f"Noise floor {self.measured.mean_absolute:.2g} mean |Δ sin θ|: {self.measured}."]
        lines += [str(finding) for finding in self.findings]
        lines += [
            f"These recordings cannot tell apart: {', '.join(group)}." for group in self.groups_in_question
        ]
        return "\n".join(lines)

    __repr__ = __str__


def diagnosis_json(diagnosis: Diagnosis) -> dict[str, Any]:
    """The machine-readable form of a diagnosis."""
    return {
        "noise_floor": diagnosis.measured.mean_absolute,
        "noise": _noise_json(diagnosis.measured),
        "ranking": [_ranked(finding) for finding in diagnosis.findings],
        "indistinguishable": [list(group) for group in diagnosis.groups],
        "suspects": diagnosis.suspects,
    }


def _noise_json(noise: NoiseModel) -> dict[str, Any]:
    """What is known of the noise; an upper bound says that nothing in the recordings shows it alone."""
    return {
        "standard_deviation": noise.standard_deviation,
        "mean_absolute": noise.mean_absolute,
        "source": noise.source,
        "upper_bound": noise.upper_bound,
    }


def _ranked(finding: Finding) -> dict[str, Any]:
    return {
        "effect": finding.effect,
        "probability": finding.probability,
        "error_removed": finding.error_removed,
        "verdict": finding.verdict.value,
        "expected": {
            name: {"value": value, "std": _finite(error), "unit": finding.units[name]}
            for name, (value, error) in finding.expected.items()
        },
        "swallowed": finding.swallowed,
        "visible_above": _finite(finding.visible_above),
    }


def _finite(number: float) -> float | None:
    return number if number == number and abs(number) != float("inf") else None
