"""The stages of an improvement and its verdict."""

from dataclasses import asdict, dataclass

from hasel_sysid.diagnosis import Diagnosis, Finding
from hasel_sysid.diagnosis.adequacy import Adequacy
from hasel_sysid.diagnosis.explained import Status
from hasel_sysid.estimation import FitResult
from hasel_sysid.improvement.open_values import open_values
from hasel_sysid.improvement.wrong_constant import WrongConstant
from hasel_sysid.noise import NoiseModel


@dataclass(frozen=True)
class Stage:
    """A model of the ladder: its effects beyond the first model's, its fit, and its error on unseen runs.

    mae_validation: mean |Δ sin θ| on runs that were never fitted; None where none were given. diagnosis: of what this
    stage leaves; None for a last stage that was not diagnosed. constant: of the model file, free here and not before.
    """

    effects: tuple[str, ...]
    fit: FitResult
    mae_validation: float | None
    diagnosis: Diagnosis | None = None
    constant: str = ""

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


@dataclass(frozen=True)
class Improvement:
    """All stages and what they come to.

    stages: baseline first; missing: effects found missing; unexplained_fraction: of the baseline's mean
    |Δ sin θ| above the noise; reason: why the improvement stopped, in a sentence; contradictions: what tells that an
    added effect is not the whole truth, in sentences; adequacy: whether the last stage describes its runs; refused:
    effects that were tried and not kept; opposed: whether runs move against the model, a fault of the set-up; constant:
    that of the model file which the last stage has free instead of any effect.
    """

    stages: list[Stage]
    status: Status
    missing: tuple[str, ...]
    unexplained_fraction: float
    noise_floor: float
    reason: str
    contradictions: tuple[str, ...] = ()
    adequacy: Adequacy | None = None
    refused: tuple[str, ...] = ()
    opposed: bool = False
    constant: WrongConstant | None = None

    @property
    def model(self):
        """The last accepted model."""
        return self.stages[-1].fit.model

    @property
    def open_values(self) -> dict[str, str]:
        """What was found missing and may do nothing by itself, each with a sentence that says why."""
        return open_values(self.model, self.missing)

    @property
    def diagnosis(self) -> Diagnosis:
        """The first diagnosis, on the baseline."""
        return self.stages[0].diagnosis

    @property
    def not_tried(self) -> list[str]:
        """Effects for which there was no time, in whichever diagnosis."""
        diagnoses = [stage.diagnosis for stage in self.stages if stage.diagnosis is not None]
        return sorted({effect for diagnosis in diagnoses for effect in diagnosis.not_tried})

    def to_json(self) -> dict:
        """The machine-readable form that `improve --json` writes."""
        return {
            **diagnosis_json(self.diagnosis),
            "noise_floor": self.noise_floor,
            "stages": [_stage(stage) for stage in self.stages],
            "verdict": {
                "status": self.status.value,
                "missing": list(self.missing),
                "unexplained_fraction": self.unexplained_fraction,
                "probability_none_of_these": self.diagnosis.probability_none,
                "explainable_at_all": self.diagnosis.ceiling,
                "reason": self.reason,
                "contradictions": list(self.contradictions),
                "open_values": list(self.open_values.values()),
                "refused": list(self.refused),
                "wrong_constant": None if self.constant is None else self.constant.to_json(),
                "not_tried": self.not_tried,
                "adequate": self.adequacy is not None and self.adequacy.adequate,
                "misfits": [] if self.adequacy is None else [asdict(m) for m in self.adequacy.misfits],
            },
        }

    def __str__(self) -> str:
        judged = [] if self.adequacy is None or self.adequacy.adequate else [str(self.adequacy)]
        return "\n".join(
            [*map(str, self.stages), self.reason, *self.contradictions, *self.open_values.values(), *judged]
        )


def diagnosis_json(diagnosis: Diagnosis) -> dict:
    """The machine-readable form of a diagnosis."""
    return {
        "noise_floor": diagnosis.measured.mean_absolute,
        "noise": noise_json(diagnosis.measured),
        "ranking": [_ranked(finding) for finding in diagnosis.findings],
        "indistinguishable": [list(group) for group in diagnosis.groups],
        "suspects": diagnosis.suspects,
    }


def noise_json(noise: NoiseModel) -> dict:
    """What is known of the noise; an upper bound says that nothing in the recordings shows it alone."""
    return {
        "standard_deviation": noise.standard_deviation,
        "mean_absolute": noise.mean_absolute,
        "source": noise.source,
        "upper_bound": noise.upper_bound,
    }


def _ranked(finding: Finding) -> dict:
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


def _stage(stage: Stage) -> dict:
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
