"""The stages of a bench's improvement, what is said of every effect, and what they come to."""

from dataclasses import dataclass
from enum import Enum

from hasel_sim.muscle.muscle import Muscle
from hasel_sysid.answer.result import Status
from hasel_sysid.estimation.fit import FittedModel
from hasel_sysid.model_checking import GoodnessOfFit

from hasel_muscle.problem import as_muscle


class BenchVerdict(Enum):
    """In the order in which they are listed."""

    MISSING = "missing"
    AS_GOOD = "as good as the one that was added"
    BEYOND = "would help, but only beyond its plausible range"
    ABSENT = "absent"
    NOT_JUDGED = "not judged"
    UNSEEN = "cannot be seen"


@dataclass(frozen=True)
class BenchFinding:
    """An effect, what is said of it, and why."""

    effect: str
    verdict: BenchVerdict
    reason: str

    def __str__(self) -> str:
        return f"{self.effect}: {self.verdict.value}; {self.reason}."


@dataclass(frozen=True)
class Described:
    """goodness: whether a law describes its lifts; error: root mean square by the largest answer, and allowed, what
    that may be; noise, repeats: what is allowed for, likewise.
    """

    goodness: GoodnessOfFit
    error: float
    allowed: float
    noise: float
    repeats: float | None

    @property
    def describes(self) -> bool:
        """Whether nothing is left but noise."""
        return self.goodness.adequate

    def __str__(self) -> str:
        of = f"noise {100 * self.noise:.2g} %"
        of += "" if self.repeats is None else f", lifts repeat to {100 * self.repeats:.2g} %"
        said = "describes these lifts" if self.describes else "does not describe these lifts yet"
        worst = "; most in " + ", ".join(map(str, self.goodness.lacking[:3])) if self.goodness.lacking else ""
        return (
            f"The model {said}: it is off by {100 * self.error:.2g} % of the largest answer, "
            f"{100 * self.allowed:.2g} % are allowed for ({of}){worst}."
        )


@dataclass(frozen=True)
class MuscleStage:
    """What was added, the fit with it, and mean |law - measurement| by unit, of fitted and of unseen lifts."""

    added: tuple[str, ...]
    fit: FittedModel
    error: dict[str, float]
    unseen: dict[str, float]
    rivals: tuple[str, ...] = ()

    @property
    def muscle(self) -> Muscle:
        """With the fitted values."""
        return as_muscle(self.fit.model)

    @property
    def effects(self) -> list[str]:
        """All that is in the model now."""
        return [effect.id for effect in self.muscle.effects]


@dataclass(frozen=True)
class BenchImprovement:
    """stages: the file's own constants, the fitted law, then with every effect added; findings: of all effects; status:
    as of the swimmer's `improve`; described: whether the last stage describes its lifts; groups: effects that these
    lifts cannot tell apart.
    """

    stages: tuple[MuscleStage, ...]
    findings: tuple[BenchFinding, ...]
    status: Status
    described: Described
    groups: tuple[tuple[str, ...], ...] = ()

    @property
    def muscle(self) -> Muscle:
        """With everything that was added."""
        return self.stages[-1].muscle

    @property
    def missing(self) -> list[str]:
        """What was added, in this order."""
        return [name for stage in self.stages[2:] for name in stage.added]
