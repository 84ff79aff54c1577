"""The stages of a bench's improvement and what they come to."""

from dataclasses import dataclass, field

from hasel_sim.muscle.muscle import Muscle

from hasel_sysid.bench_muscle.adequacy import Adequacy
from hasel_sysid.bench_muscle.fit import BenchFit
from hasel_sysid.bench_muscle.verdict import Finding


@dataclass(frozen=True)
class Stage:
    """What was added, the fit with it, and mean |law - measurement| by unit, of fitted and of unseen lifts."""

    added: str
    fit: BenchFit
    error: dict[str, float]
    unseen: dict[str, float]
    rivals: tuple[str, ...] = ()

    @property
    def effects(self) -> list[str]:
        """All that is in the model now."""
        return [effect.id for effect in self.fit.muscle.effects]


@dataclass(frozen=True)
class BenchImprovement:
    """stages: the file's own constants, the fitted law, then with every effect added; findings: of all effects."""

    stages: tuple[Stage, ...]
    findings: tuple[Finding, ...]
    adequacy: Adequacy
    first: Adequacy
    groups: tuple[tuple[str, ...], ...] = field(default=())

    @property
    def muscle(self) -> Muscle:
        """With everything that was added."""
        return self.stages[-1].fit.muscle

    @property
    def missing(self) -> list[str]:
        """What was added, in this order."""
        return [stage.added for stage in self.stages[2:]]

    @property
    def status(self) -> str:
        """As of the swimmer's `improve`."""
        if self.adequacy.describes:
            return "explained" if self.missing else "nothing_missing"
        return "partly_explained" if self.missing else "unexplained"
