"""Where a model fails: run by run, in all runs together, and in which part of the cycle."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hasel_sysid.where_it_fails.failure import Failure
from hasel_sysid.where_it_fails.in_all_runs import failures_in_all_runs
from hasel_sysid.where_it_fails.in_one_run import RunAnalysis, analyse_run
from hasel_sysid.where_it_fails.run_series import RunSeries

_SHARE_OF_NOISE = 0.75
_STANDS_OUT = 1.5
_MOST_SINGLE = 6


@dataclass(frozen=True)
class WhereItFails:
    """runs: analysis of each run; failures: what many runs have in common, largest first.

    phase [bins] with profile [bins]: residual by phase of the cycle, mean magnitude over the runs relative to each
    run's own mean; empty without a cycle.
    """

    runs: tuple[RunAnalysis, ...]
    failures: tuple[Failure, ...]
    phase: np.ndarray
    profile: np.ndarray

    @property
    def noise(self) -> float:
        """Median over the runs of the noise in sin theta."""
        return float(np.median([run.noise for run in self.runs])) if self.runs else 0.0

    def sentences(self) -> list[str]:
        """What a researcher would say, most important first; single runs only where the runs have nothing in common."""
        single = [failure for run in self.runs for failure in run.failures]
        said = [str(f) for f in self.failures or sorted(single, key=lambda f: -f.size)[:_MOST_SINGLE]]
        worst = self._worst_phase()
        said += [] if worst is None else [worst]
        return said or ["No systematic difference stands out from the noise."]

    def _worst_phase(self) -> str | None:
        if len(self.profile) == 0 or np.nanmax(self.profile) < _STANDS_OUT * np.nanmean(self.profile):
            return None
        at = float(self.phase[int(np.nanargmax(self.profile))])
        run = next(run.run for run in self.runs if run.profile is not None)
        side = run.cycle.side
        one, other = _channel_names(run)
        first, second = (one, other) if side[0] > 0 else (other, one)
        alternates = bool(np.any(side != side[0]))
        muscle, since = (second, at - 0.5) if alternates and at >= 0.5 else (first, at)
        return (
            f"The error is largest {100 * since:.0f} % of a cycle after {muscle} is switched on, "
            f"{np.nanmax(self.profile):.1f} times its mean."
        )

    def __str__(self) -> str:
        return "\n".join(self.sentences())


def _channel_names(run: RunSeries) -> tuple[str, str]:
    """What a sentence calls the first channel and the other one."""
    names = [
        f"the {c.name} muscle" if c.quantity == "voltage" else f"the {c.quantity} of {c.name}"
        for c in run.channels
    ]
    return names[0], names[1] if len(names) == 2 else "another channel"


def where_it_fails(runs: Sequence[RunSeries]) -> WhereItFails:
    """Analyse runs that were simulated with one model."""
    analyses = tuple(analyse_run(run) for run in runs)
    noise = float(np.median([a.noise for a in analyses])) if analyses else 0.0
    failures = failures_in_all_runs(runs, [a.components for a in analyses], _SHARE_OF_NOISE * noise)
    profiles = [a.profile for a in analyses if a.profile is not None]
    if not profiles:
        return WhereItFails(analyses, tuple(failures), np.zeros(0), np.zeros(0))
    relative = [p.absolute / max(float(np.nanmean(p.absolute)), 1e-12) for p in profiles]
    known = np.ma.masked_invalid(relative)  # at few frames a cycle there are phases without any
    return WhereItFails(analyses, tuple(failures), profiles[0].phase, known.mean(axis=0).filled(np.nan))
