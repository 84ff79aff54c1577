"""A way in which the model fails, in one run or in all of them, that prints as a sentence."""

from dataclasses import asdict, dataclass

from hasel_sysid.where_it_fails.component import Component
from hasel_sysid.where_it_fails.sentences import words


@dataclass(frozen=True)
class Failure:
    """component: what and how much; where: name of the run, or "all runs"; remark: what it depends on, may be empty."""

    component: Component
    where: str
    remark: str = ""

    @property
    def size(self) -> float:
        """Rms of sin theta that it accounts for."""
        return self.component.size

    @property
    def predicate(self) -> str:
        """The sentence without its subject: "lags 35 ms after every switch, more at 3.5 Hz"."""
        return words(self.component) + (f", {self.remark}" if self.remark else "")

    def __str__(self) -> str:
        return f"{self.where}: {self.predicate} (rms {self.size:.2g} of sin θ)."

    def to_json(self) -> dict:
        """Plain numbers and words."""
        return {
            "kind": self.component.kind.value,
            "where": self.where,
            "value": self.component.value,
            "std": self.component.standard_error,
            "unit": self.component.unit,
            "size": self.size,
            "detail": asdict(self.component)["detail"],
            "sentence": str(self),
        }
