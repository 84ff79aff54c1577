# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Results of the steps: each prints as sentences and plots."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import SupportsIndex, overload

from hasel_sim.model import Model

from hasel_sysid.answer.diagnosis import Diagnosis, Verdict
from hasel_sysid.answer.result import Improvement
from hasel_sysid.api.drawing import Picture, draw_comparisons, draw_ranking, draw_recordings, draw_stages
from hasel_sysid.comparison import Comparison
from hasel_sysid.estimation import FittedModel
from hasel_sysid.experiment import Experiment
from hasel_sysid.report.wording import found_values

_MOST_SAID = 8


class Recordings(tuple[Experiment, ...]):
    """Recordings that were read; a tuple, so that they can be chosen from by number and added."""

    @overload
    def __getitem__(self, which: SupportsIndex) -> Experiment: ...

    @overload
    def __getitem__(self, which: slice) -> "Recordings": ...

    def __getitem__(self, which: SupportsIndex | slice) -> "Experiment | Recordings":
        """One of them, or some of them for a slice."""
        if isinstance(which, slice):
            return Recordings(super().__getitem__(which))
        return super().__getitem__(which)

    def __add__(self, other: Sequence[Experiment]) -> "Recordings":  # type: ignore[override]
        return Recordings((*self, *other))

    def __str__(self) -> str:
        return "\n".join(str(each.recording) for each in self)

    __repr__ = __str__

    def plot(self) -> Picture:
        """Measured sin θ of every recording."""
        return draw_recordings(self)


@dataclass(frozen=True)
class Simulated:
    """Recordings simulated with a model. comparison: errors of every run, and where the model fails."""

    comparison: Comparison

    @property
    def model(self) -> Model:
        """The model that was simulated."""
        return self.comparison.model

    def __str__(self) -> str:
        return "\n".join([str(self.comparison), *(f"  {line}" for line in self.comparison.where.sentences())])

    __repr__ = __str__

    def plot(self, *others: "Simulated") -> Picture:
        """Measured against simulated, with other models beside this one."""
        return draw_comparisons([self.comparison, *(other.comparison for other in others)])


@dataclass(frozen=True)
class Fitted(Simulated):
    """A fitted model. result: values, standard errors, and what the recordings do not determine."""

    result: FittedModel

    def __str__(self) -> str:
        return f"{self.result}\n{super().__str__()}"

    __repr__ = __str__


@dataclass(frozen=True)
class Diagnosed:
    """Which effects are missing. diagnosis: what is said of each; fitted: the model that was diagnosed."""

    diagnosis: Diagnosis
    fitted: FittedModel

    def __str__(self) -> str:
        said = [each for each in self.diagnosis.findings if each.verdict is not Verdict.ABSENT]
        absent = len(self.diagnosis.findings) - len(said)
        lines = [
            f"Noise floor {self.diagnosis.measured.mean_absolute:.2g} mean |Δ sin θ|.",
            *map(str, said[:_MOST_SAID]),
            *([f"Of {len(said) - _MOST_SAID} others less is to be said."] if len(said) > _MOST_SAID else []),
            *([f"{absent} further effects are absent; all are in diagnosis.findings."] if absent else []),
            str(self.diagnosis.goodness or ""),
        ]
        return "\n".join(filter(None, lines))

    __repr__ = __str__

    def plot(self) -> Picture:
        """The most probable effects, with the share of the error that each removes."""
        return draw_ranking(self.diagnosis)


@dataclass(frozen=True)
class Improved:
    """A model with what was missing. improvement: all stages, verdict and reasons."""

    improvement: Improvement

    @property
    def model(self) -> Model:
        """The last stage's."""
        return self.improvement.model

    def __str__(self) -> str:
        return "\n".join([str(self.improvement), *found_values(self.improvement)])

    __repr__ = __str__

    def plot(self) -> Picture:
        """The error falling, on fitted and on unseen runs."""
        return draw_stages(self.improvement.stages, self.improvement.noise_floor)
