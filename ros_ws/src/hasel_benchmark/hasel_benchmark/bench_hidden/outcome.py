# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What became of one case: the answer of `improve` beside what only the benchmark knows."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from hasel_sim.effects.registry import catalogue

from hasel_benchmark.bench_hidden.hidden_cases import FAULTS, Case
from hasel_benchmark.bench_hidden.laboratory import Laboratory

NORMAL_95 = 1.96
"""Standard deviations of a normal distribution within which 95 % lie."""
VISIBLE_SHARE = 0.5
"""A hidden effect is visible when the fitted baseline's excess rms is at least this share of the noise's."""


@dataclass(frozen=True)
class Estimate:
    """An effect's parameter as `improve` found it, and as it was."""

    name: str
    value: float
    standard_error: float | None
    truth: float

    @property
    def covered(self) -> bool | None:
        """Whether the 95 % interval holds the truth; None without an interval."""
        if self.standard_error is None or not np.isfinite(self.standard_error):
            return None
        return abs(self.value - self.truth) <= NORMAL_95 * self.standard_error


@dataclass(frozen=True)
class Outcome:
    """hidden: ids; ranked: ids, most probable first; missing: ids that `improve` says are missing and adds.

    mae_*: mean |Δ sin θ| of the fitted baseline and of the last stage; floor_*: of the noise alone;
    probability: that `improve` gives the effect ranked first; cores: that `improve` had; failure: why there is no
    answer; all else is empty then; fault: of the set-up that is hidden; set_up: what `improve` says of the set-up.
    """

    case: str
    kind: str
    hidden: tuple[str, ...]
    size: float
    colour: str
    numerics: str
    status: str = ""
    missing: tuple[str, ...] = ()
    ranked: tuple[str, ...] = ()
    groups: tuple[tuple[str, ...], ...] = ()
    mae_fitted: tuple[float, float] = (np.nan, np.nan)
    mae_unseen: tuple[float, float] = (np.nan, np.nan)
    floor_fitted: float = np.nan
    floor_unseen: float = np.nan
    estimates: tuple[Estimate, ...] = ()
    seconds: float = np.nan
    probability: float = np.nan
    cores: int = 1
    failure: str = ""
    fault: str = ""
    set_up: str = ""

    @property
    def visible(self) -> bool:
        """Whether the hidden effect leaves anything to be found once the baseline is fitted."""
        excess = max(self.mae_fitted[0] ** 2 - self.floor_fitted**2, 0.0)
        return excess >= (VISIBLE_SHARE * self.floor_fitted) ** 2

    @property
    def reports_something(self) -> bool:
        """Whether anything is said to be missing."""
        return self.status != "nothing_missing"

    @property
    def first(self) -> str:
        """The effect named first, empty when nothing is said to be missing."""
        return self.ranked[0] if self.ranked and self.reports_something else ""

    @property
    def right(self) -> bool:
        """Whether the effect named first is a hidden one."""
        return self.first in self.hidden

    @property
    def right_within_group(self) -> bool:
        """Right, or stated to be indistinguishable from a hidden one."""
        return self.right or any(alike(self.first, one, self.groups) for one in self.hidden)

    @property
    def exact(self) -> bool:
        """Whether what is said to be missing is what is hidden, and nothing beside it."""
        own = FAULTS[self.fault].effect if self.fault else ""
        return set(self.missing) == {*self.hidden, *filter(None, [own])}

    @property
    def fault_named(self) -> bool:
        """Whether the hidden fault of the set-up is said, or the effect is named that is this fault."""
        fault = FAULTS[self.fault]
        return fault.effect in self.missing or any(words in self.set_up for words in fault.said)

    @property
    def group_size(self) -> int:
        """Of the stated group that holds the first effect named, or one."""
        return max((len(group) for group in self.groups if self.first in group), default=1)

    @property
    def accuses_with_confidence(self) -> bool:
        """Whether the listed effects are said to explain what was seen."""
        return self.status == "explained" and bool(self.missing)

    @property
    def says_none_of_them(self) -> bool:
        """Whether the listed effects are said not to explain, or not wholly, what was seen."""
        return self.status in ("unexplained", "partly_explained")

    @property
    def all_named(self) -> bool:
        """Whether every hidden effect is among those added."""
        return set(self.hidden) <= set(self.missing)

    @property
    def all_named_within_group(self) -> bool:
        """The same, a stated indistinguishable one counting for each."""
        return all(
            one in self.missing or any(alike(m, one, self.groups) for m in self.missing)
            for one in self.hidden
        )

    @property
    def removed_fitted(self) -> float:
        """Share of the fitted baseline's error above the noise that is gone at the last stage, on fitted runs."""
        return _removed(self.mae_fitted, self.floor_fitted)

    @property
    def removed_unseen(self) -> float:
        """The same on unseen runs."""
        return _removed(self.mae_unseen, self.floor_unseen)


def alike(first: str, second: str, groups: Sequence[Sequence[str]]) -> bool:
    """Whether one of the stated groups holds both."""
    return any(first in group and second in group for group in groups)


def _removed(error: tuple[float, float], floor: float) -> float:
    excess = error[0] - floor
    return (error[0] - error[1]) / excess if excess > 0 else np.nan


def outcome_from_dict(content: dict[str, Any]) -> Outcome:
    """Read back what was kept as JSON."""
    lists = {
        name: tuple(content[name]) for name in ("hidden", "missing", "ranked", "mae_fitted", "mae_unseen")
    }
    groups = tuple(tuple(group) for group in content["groups"])
    estimates = tuple(Estimate(**one) for one in content["estimates"])
    return Outcome(**{**content, **lists, "groups": groups, "estimates": estimates})


def judge(case: Case, laboratory: Laboratory, answer: dict[str, Any], seconds: float) -> Outcome:
    """answer: what `improve --json` writes; seconds: how long it took."""
    stages, verdict = answer["stages"], answer["verdict"]
    return Outcome(
        **_told_by(case),
        status=verdict["status"],
        missing=tuple(verdict["missing"]),
        ranked=tuple(entry["effect"] for entry in answer["ranking"]),
        groups=tuple(tuple(group) for group in answer["indistinguishable"]),
        mae_fitted=(stages[0]["mae_fit"], stages[-1]["mae_fit"]),
        mae_unseen=(stages[0]["mae_validation"], stages[-1]["mae_validation"]),
        floor_fitted=laboratory.floor_fitted,
        floor_unseen=laboratory.floor_unseen,
        estimates=_estimates(laboratory.values, stages[-1]["parameters"]),
        seconds=seconds,
        set_up=verdict.get("set_up") or "",
        probability=float(answer["ranking"][0].get("probability", np.nan)) if answer["ranking"] else np.nan,
    )


def failed(case: Case, failure: str) -> Outcome:
    """The outcome of a case without an answer."""
    return Outcome(**_told_by(case), failure=failure)


def _told_by(case: Case) -> dict[str, Any]:
    own = {name: getattr(case, name) for name in ("kind", "size", "colour", "numerics", "fault")}
    return {"case": case.name, "hidden": case.effects, **own}


def _estimates(
    values: dict[str, dict[str, float]], fitted: dict[str, dict[str, Any]]
) -> tuple[Estimate, ...]:
    """Parameters that have a value without effect; one that has none (a relaxation time) says nothing of its size."""
    own = [
        (f"{identity}.{p.name}", values[identity][p.name])
        for identity in values
        if identity in catalogue()
        for p in catalogue()[identity].parameters
        if not p.scan
    ]
    return tuple(
        Estimate(name, fitted[name]["value"], fitted[name].get("std"), truth)
        for name, truth in own
        if name in fitted
    )
