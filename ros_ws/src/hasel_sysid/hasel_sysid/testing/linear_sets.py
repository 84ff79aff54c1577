"""A problem of sets of effects without a simulator: every effect adds a known series, and the noise is known."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from hasel_sysid.noise import NoiseModel
from hasel_sysid.selection.sets import EffectSet, FittedSet, Look, Prospect, Rank, Wanted

RUNS, FRAMES = 8, 80


def run_numbers(runs: int = RUNS, frames: int = FRAMES) -> np.ndarray:
    """Number of the run of every frame, [frames]."""
    return np.repeat(np.arange(runs), frames)


def smooth_series(generator: np.random.Generator, runs: np.ndarray) -> np.ndarray:
    """A few tones in every run, with an rms of 1, [frames]."""
    series = np.empty(len(runs))
    for run in np.unique(runs):
        time = np.arange((runs == run).sum()) / 120.0
        tones = np.sin(
            2 * np.pi * np.outer(time, generator.uniform(0.5, 8.0, 5)) + generator.uniform(0, 6.3, 5)
        )
        own = tones @ generator.standard_normal(5)
        series[runs == run] = (own - own.mean()) / own.std()
    return series


class LinearSets:
    """measured = what two free constants do + the sizes times the series of the effects + noise.

    As of `selection.sets.Sets`; `fits` counts the full fits, `asked` tells them, with what was foreseen at each.
    """

    at_null: Collection[str] = ()

    def __init__(
        self,
        series: Mapping[str, np.ndarray],
        sizes: Mapping[str, float],
        noise: NoiseModel,
        seed: int = 0,
        stranger: np.ndarray | None = None,
        exclusive: Collection[frozenset[str]] = (),
        runs: np.ndarray | None = None,
        most_fits: float = np.inf,
        slack: Sequence[np.ndarray] = (),
        swing: float = 0.0,
    ) -> None:
        """series [frames] of every effect; sizes: of those that are there; stranger [frames]: what is none of them;
        exclusive: sets of effects that do not go together; most_fits: after which the time is over; slack: errors
        [frames] that every set is known to make; swing: the largest, for what no model has.
        """
        self.runs = run_numbers() if runs is None else runs
        self.slack, self.swing = np.column_stack([np.zeros((len(self.runs), 0)), *slack]), swing
        self.series, self._noise, self._exclusive = dict(series), noise, tuple(exclusive)
        generator = np.random.default_rng([seed, 17])
        self._own = np.column_stack([smooth_series(generator, self.runs) for _ in range(2)])
        truth = self._own @ np.array([1.0, -2.0]) + (0.0 if stranger is None else stranger)
        truth = truth + sum((size * self.series[name] for name, size in sizes.items()), start=0.0)
        self.measured = self._centred(truth[:, None] + noise.sample(self.runs, 1, generator))[:, 0]
        self.fits, self._most_fits = 0, most_fits
        self.foreseen: list[EffectSet] = []
        self.asked: list[tuple[EffectSet, list[EffectSet]]] = []

    def baseline(self) -> FittedSet:
        """Without any effect."""
        return self._fitted(frozenset())

    def noise(self, known: Collection[FittedSet]) -> NoiseModel:
        """The noise itself."""
        return self._noise

    def compatible(self, effects: EffectSet) -> bool:
        """Whether these go together."""
        return not any(pair <= effects for pair in self._exclusive)

    def prospects(
        self,
        of: FittedSet,
        wanted: Collection[str] | None,
        rank: Rank,
        most: int,
        sized: Mapping[str, FittedSet] | None = None,
    ) -> dict[str, Prospect]:
        """Every other effect at its null."""
        names = [name for name in (self.series if wanted is None else wanted) if name not in of.effects]
        return {name: self._prospect(of, name) for name in names}

    def prospects_of_each(self, looks: Sequence[Look], rank: Rank, most: int) -> list[dict[str, Prospect]]:
        """One after the other."""
        return [self.prospects(of, wanted, rank, most) for of, wanted in looks]

    def foresee(self, likely: Sequence[Wanted]) -> None:
        """Keep in mind what was said to be likely."""
        self.foreseen = [effects for effects, _, _ in likely]

    def fit(self, effects: EffectSet, near: FittedSet, added: Sequence[Prospect]) -> FittedSet | None:
        """Least squares."""
        self.fits += 1
        self.asked.append((effects, [likely for likely in self.foreseen if likely != effects]))
        return self._fitted(effects)

    def from_other_sizes(self, of: FittedSet, prospect: Prospect) -> Prospect | None:
        """None: least squares end at one place from everywhere."""

    def deepest(self, of: FittedSet) -> FittedSet:
        """The same: there is one valley."""
        return of

    def without(self, of: FittedSet, gone: str) -> FittedSet | None:
        """What the effect did is left, all else is as it was."""
        stays = [number for number, owner in enumerate(of.owners) if owner != gone]
        return replace(
            of,
            effects=of.effects - {gone},
            residual=of.residual + of.without[gone],
            jacobian=of.jacobian[:, stays],
            lower=of.lower[stays],
            upper=of.upper[stays],
            owners=tuple(of.owners[number] for number in stays),
            without={effect: change for effect, change in of.without.items() if effect != gone},
        )

    def out_of_time(self) -> bool:
        """Whether as many fits were made as may be."""
        return self.fits >= self._most_fits

    def _prospect(self, of: FittedSet, name: str) -> Prospect:
        own = self._centred(self.series[name][:, None])
        jacobian = np.column_stack([of.jacobian, own])
        free = np.full(jacobian.shape[1], np.inf)
        return Prospect(name, of.residual, jacobian, 1, -free, free, own, of.effects)

    def _fitted(self, effects: EffectSet) -> FittedSet:
        names = sorted(effects)
        columns = self._centred(np.column_stack([self._own, *(self.series[name] for name in names)]))
        values = np.linalg.lstsq(columns, self.measured, rcond=None)[0]
        free = np.full(columns.shape[1], np.inf)
        return FittedSet(
            effects,
            self.measured - columns @ values,
            columns,
            -free,
            free,
            ("", "", *names),
            {name: values[2 + n] * columns[:, 2 + n] for n, name in enumerate(names)},
        )

    def _centred(self, columns: np.ndarray) -> np.ndarray:
        out = columns.astype(float)
        for run in np.unique(self.runs):
            out[self.runs == run] -= out[self.runs == run].mean(axis=0)
        return out
