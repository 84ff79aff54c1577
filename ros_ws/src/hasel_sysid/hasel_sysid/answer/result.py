# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What an improvement comes to, stage by stage; how it prints and goes into JSON."""

from collections.abc import Collection, Sequence
from dataclasses import asdict, dataclass
from enum import Enum
from typing import Any

import numpy as np
from hasel_sim.effects.base import Effect
from hasel_sim.model import Model, Parameter
from hasel_sim.parameter import value_with_error

from hasel_sysid.answer.diagnosis import Diagnosis, diagnosis_json
from hasel_sysid.answer.set_up import SetUpFault
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation.fit import FittedModel
from hasel_sysid.model_checking import GoodnessOfFit
from hasel_sysid.policy import POLICY
from hasel_sysid.selection.choose import TABLE_HEAD, ComparedModel

_COLLINEAR = 0.95
"""Correlation of two errors from which what the one value takes the other gives."""


def open_values(model: Model, effects: Collection[str]) -> dict[str, str]:
    """Of these effects of a fitted model those whose intervals all hold the value at which they do nothing, each with a
    sentence: its first size, and the other value that is known only together with it, if there is one.

    Together such effects may be needed all the same: then their sum is known, and not the parts.
    """
    chosen = [effect for effect in model.effects if effect.id in effects]
    return {effect.id: sentence for effect in chosen if (sentence := _open(model, effect))}


def _open(model: Model, effect: Effect) -> str | None:
    sizes = {f"{effect.id}.{p.name}": p.null for p in effect.parameters if not p.scan}
    fitted = {name: null for name, null in sizes.items() if model.parameters[name].free}
    if not fitted or not all(_may_be(model, name, null) for name, null in fitted.items()):
        return None
    name, null = next(iter(fitted.items()))
    unit = "" if model.parameters[name].unit == "1" else f" {model.parameters[name].unit}"
    other, correlation = _closest(model, name, leave_out=sizes)
    instead = f"; {other} can do the same (correlation {correlation:+.2f})" if other else ""
    return f"{name} is not known: its interval holds {null:g}{unit}, at which it does nothing{instead}."


def _may_be(model: Model, name: str, value: float) -> bool:
    error = model.parameters[name].standard_error
    return error is not None and abs(model.parameters[name].value - value) <= POLICY.confidence * error


def _closest(model: Model, name: str, leave_out: Collection[str]) -> tuple[str | None, float]:
    """The collinear parameter that is not one of these, and the correlation of the errors; None where there is none."""
    others = [other for other in model.free if other == name or other not in leave_out]
    covariance = model.covariance(others)
    row = others.index(name)
    with np.errstate(divide="ignore", invalid="ignore"):
        errors = np.sqrt(np.diag(covariance))
        correlation = np.nan_to_num(covariance[row] / (errors[row] * errors))
    correlation[row] = 0.0
    best = int(np.argmax(np.abs(correlation)))
    found = float(correlation[best])
    return (others[best], found) if abs(found) >= _COLLINEAR else (None, 0.0)


class Status(str, Enum):
    """What a search for missing effects comes to."""

    NOTHING_MISSING = "nothing_missing"
    EXPLAINED = "explained"
    PARTLY_EXPLAINED = "partly_explained"
    UNEXPLAINED = "unexplained"


@dataclass(frozen=True)
class Stage:
    """A model of the ladder: its effects beyond the first model's, its fit, and its error on unseen runs.

    mae_validation: mean |Δ sin θ| on runs that were never fitted; None where none were given. diagnosis: of what this
    stage leaves; None for a last stage that was not diagnosed. constant: of the model file, free here and not before.
    """

    effects: tuple[str, ...]
    fit: FittedModel
    mae_validation: float | None
    diagnosis: Diagnosis | None = None
    constant: str = ""

    @property
    def diagnosed(self) -> Diagnosis:
        """The diagnosis of what it leaves. Raises SysidError where it was not diagnosed."""
        if self.diagnosis is None:
            raise SysidError("this stage was not diagnosed; diagnose what it leaves first")
        return self.diagnosis

    @property
    def added(self) -> tuple[str, ...]:
        """What it has beyond the fitted first model."""
        return (*self.effects, *filter(None, [self.constant]))

    @property
    def mae_fit(self) -> float:
        """Mean |Δ sin θ| on the fitted runs."""
        return self.fit.mean_absolute_error

    def __str__(self) -> str:
        what = " + ".join(("baseline", *self.added))
        unseen = "" if self.mae_validation is None else f", {self.mae_validation:.5f} on unseen runs"
        return f"{what}: mean |Δ sin θ| {self.mae_fit:.5f} on fitted runs{unseen}"

    __repr__ = __str__


@dataclass(frozen=True)
class WrongConstant:
    """name: its path in the model file; fit: of the model with it free, instead of any effect; instead_of: the effects
    that come to no more; empty where no effects do.
    """

    name: str
    given: float
    fit: FittedModel
    instead_of: frozenset[str]

    @property
    def parameter(self) -> Parameter:
        """Its value and standard error."""
        return self.fit.model.parameters[self.name]

    def __str__(self) -> str:
        p = self.parameter
        value = value_with_error(p.value, p.standard_error, p.unit)
        unit = "" if p.unit == "1" else f" {p.unit}"
        does = (
            f"does as much as {' + '.join(sorted(self.instead_of))}"
            if self.instead_of
            else "does what no listed effect does"
        )
        return (
            f"One number of the model file, {self.name} = {value} in place of {self.given:g}{unit}, {does}: measure it "
            "before an effect is believed in."
        )

    __repr__ = __str__

    def to_json(self) -> dict[str, Any]:
        """For `improve --json`."""
        p = self.parameter
        return {
            "name": self.name,
            "given": self.given,
            "value": p.value,
            "std": p.standard_error,
            "unit": p.unit,
            "instead_of": sorted(self.instead_of),
        }


@dataclass(frozen=True)
class Improvement:
    """All stages and what they come to.

    stages: baseline first; missing: effects found missing; unexplained_fraction: of the baseline's mean
    |Δ sin θ| above the noise; reason: why the improvement stopped, in a sentence; contradictions: what tells that an
    added effect is not the whole truth, in sentences; goodness: whether the last stage describes its runs; refused:
    effects that were tried and not kept; set_up: the fault of the set-up with which the runs were read; constant:
    that of the model file which the last stage has free instead of any effect; models: every model that was fitted,
    best first.
    """

    stages: list[Stage]
    status: Status
    missing: tuple[str, ...]
    unexplained_fraction: float
    noise_floor: float
    reason: str
    contradictions: tuple[str, ...] = ()
    goodness: GoodnessOfFit | None = None
    refused: tuple[str, ...] = ()
    set_up: SetUpFault | None = None
    constant: WrongConstant | None = None
    models: tuple[ComparedModel, ...] = ()

    @property
    def why(self) -> str:
        """How the runs were read, where that is not as recorded, and why the improvement stopped."""
        return " ".join(filter(None, [str(self.set_up or ""), self.reason]))

    @property
    def model(self) -> Model:
        """The last accepted model."""
        return self.stages[-1].fit.model

    @property
    def open_values(self) -> dict[str, str]:
        """What was found missing and may do nothing by itself, each with a sentence that says why."""
        return open_values(self.model, self.missing)

    @property
    def diagnosis(self) -> Diagnosis:
        """The first diagnosis, on the baseline."""
        return self.stages[0].diagnosed

    @property
    def not_tried(self) -> list[str]:
        """Effects for which there was no time, in whichever diagnosis."""
        diagnoses = [stage.diagnosis for stage in self.stages if stage.diagnosis is not None]
        return sorted({effect for diagnosis in diagnoses for effect in diagnosis.not_tried})

    def to_json(self) -> dict[str, Any]:
        """The machine-readable form that `improve --json` writes."""
        return {
            **diagnosis_json(self.diagnosis),
            "noise_floor": self.noise_floor,
            "stages": [_stage(stage) for stage in self.stages],
            "models": [_compared(model) for model in self.models],
            "verdict": {
                "status": self.status.value,
                "missing": list(self.missing),
                "unexplained_fraction": self.unexplained_fraction,
                "probability_none_of_these": self.diagnosis.probability_none,
                "explainable_at_all": self.diagnosis.ceiling,
                "reason": self.why,
                "contradictions": list(self.contradictions),
                "open_values": list(self.open_values.values()),
                "refused": list(self.refused),
                "set_up": None if self.set_up is None else str(self.set_up),
                "wrong_constant": None if self.constant is None else self.constant.to_json(),
                "not_tried": self.not_tried,
                "adequate": self.goodness is not None and self.goodness.adequate,
                "misfits": [] if self.goodness is None else [asdict(m) for m in self.goodness.lacking],
            },
        }

    def __str__(self) -> str:
        judged = [] if self.goodness is None or self.goodness.adequate else [str(self.goodness)]
        return "\n".join(
            [*map(str, self.stages), self.why, *self.contradictions, *self.open_values.values(), *judged]
        )

    __repr__ = __str__


def table_of_models(models: Sequence[ComparedModel]) -> str:
    """As ArviZ' `compare` prints it."""
    return "\n".join([TABLE_HEAD, *map(str, models)])


def _compared(model: ComparedModel) -> dict[str, Any]:
    return {
        "effects": list(model.effects),
        "elpd": model.elpd,
        "elpd_diff": model.difference,
        "elpd_diff_error": model.error,
        "weight": model.weight,
        "parameters": model.parameters,
        "status": model.status,
    }


def _stage(stage: Stage) -> dict[str, Any]:
    return {
        "effects": list(stage.effects),
        "constant": stage.constant or None,
        "parameters": {
            name: {"value": p.value, "std": p.standard_error, "unit": p.unit}
            for name, p in stage.fit.model.parameters.items()
        },
        "mae_fit": stage.mae_fit,
        "mae_validation": stage.mae_validation,
    }
