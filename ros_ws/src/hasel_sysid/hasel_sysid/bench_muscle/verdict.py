"""What is said of one effect of the bench."""

from dataclasses import dataclass
from enum import Enum

from hasel_sim.muscle.effect import MuscleEffect

from hasel_sysid.bench_muscle.fit import BenchFit
from hasel_sysid.bench_muscle.left_out import Advantage


class Verdict(Enum):
    """In the order in which they are listed."""

    MISSING = "missing"
    AS_GOOD = "as good as the one that was added"
    BEYOND = "would help, but only beyond its plausible range"
    ABSENT = "absent"
    NOT_JUDGED = "not judged"
    UNSEEN = "cannot be seen"


@dataclass(frozen=True)
class Trial:
    """An effect beside those there already, fitted, with what it gains on voltages left out."""

    effect: str
    fit: BenchFit
    left_out: tuple[float, ...]
    gain: Advantage

    @property
    def beyond(self) -> bool:
        """Whether a number of its own would leave its plausible range; a size may be nothing, a time may not."""
        for p in self._kind.parameters:
            fitted = self.fit.muscle.parameters[f"{self.effect}.{p.name}"]
            nothing = not p.scan and fitted.value < 0.5 * (fitted.lower + fitted.upper)
            if fitted.name in self.fit.at_bound and not nothing:
                return True
        return False

    @property
    def _kind(self) -> MuscleEffect:
        return next(effect for effect in self.fit.muscle.effects if effect.id == self.effect)


@dataclass(frozen=True)
class Finding:
    """An effect, what is said of it, and why."""

    effect: str
    verdict: Verdict
    reason: str

    def __str__(self) -> str:
        return f"{self.effect}: {self.verdict.value}; {self.reason}."
