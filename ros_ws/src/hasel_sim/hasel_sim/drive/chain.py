# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The whole drive: commanded signal -> supply and electrode effects -> target -> response -> contraction.

The target is that of the amplitudes or of the law of the Peano-HASEL against an elastic body; it has a corner where a
drive begins, or ceases, to contract a muscle.
"""

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np

from hasel_sim.drive.amplitudes import limit_rate, target_contraction
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import DriveEffect, DriveStage, guarded
from hasel_sim.effects.first_order_lag import first_order_lag
from hasel_sim.model import Model
from hasel_sim.model.muscle_law import GAIN, PRELOAD, STIFFNESS, MuscleLaw
from hasel_sim.muscle.muscle import Muscle

_SHARP = 1e-6
_SOON_S = 8e-3 * 0.5 ** np.arange(20)
_BODY = "parallel_stiffness"
_SECANTS = 3
"""They bring the instant of an onset from 5 % of its delay to less than 0.1 %."""
_TO_TARGET = [stage for stage in DriveStage if stage < DriveStage.TARGET]
_FROM_TARGET = [stage for stage in DriveStage if stage >= DriveStage.TARGET]


class Crossings(NamedTuple):
    """Where a magnitude passes the onset of its channel, between two times; [crossings] each.

    cell: number of the earlier of the two times; share: of the way between them, the magnitude taken to change
    steadily; off: by how much it misses the onset at the nearer of the two, over the onset.
    """

    cell: np.ndarray
    channel: np.ndarray
    share: np.ndarray
    off: np.ndarray


def crossings(time: np.ndarray, signal: np.ndarray, onsets: np.ndarray) -> Crossings:
    """Of a signal [n, channels] at its times [s] [n], in their order; onsets: [channels], 0 where there is none.

    Equal times mark a jump, which crosses in no time.
    """
    magnitude = np.abs(signal)
    above = magnitude > onsets
    passes = (above[1:] != above[:-1]) & (np.diff(time) > 0.0)[:, None] & (onsets > 0.0)
    cell, channel = np.nonzero(passes)
    onset = onsets[channel]
    before, after = magnitude[cell, channel] - onset, magnitude[cell + 1, channel] - onset
    share = before / (before - after)
    off = np.minimum(np.abs(before), np.abs(after)) / onset
    order = np.lexsort((share, cell))
    return Crossings(cell[order], channel[order], share[order], off[order])


def soon_after_switches(schedule: DriveSchedule, onsets: np.ndarray) -> np.ndarray:
    """Times [s] after the switches past an onset [channels], for whatever follows them, however fast.

    By halves from 8 ms, twice the usual step of a simulation, down to the difference step of a lag's derivative.
    """
    above = np.vstack([np.zeros(len(onsets), dtype=bool), np.abs(schedule.signal) > onsets])
    passes = np.any(above[1:] != above[:-1], axis=1)
    return (schedule.time[passes][:, None] + _SOON_S).ravel()


def secants(found: Crossings, origin: np.ndarray) -> np.ndarray:
    """Times [s] nearer to the crossings that lie between two times of `origin` [n] and near to neither."""
    blurred = found.off > _SHARP
    cell = found.cell[blurred]
    return origin[cell] + found.share[blurred] * (origin[cell + 1] - origin[cell])


def with_onsets(
    time: np.ndarray, signal: np.ndarray, onsets: np.ndarray, found: Crossings
) -> tuple[np.ndarray, np.ndarray]:
    """The signal [n, channels] at its times [s] [n] and, besides, at its onsets [channels] where it crosses them."""
    cell, channel, share, _ = found
    rows = signal[cell] + share[:, None] * (signal[cell + 1] - signal[cell])
    sign = np.where(signal[cell, channel] + signal[cell + 1, channel] < 0.0, -1.0, 1.0)
    rows[np.arange(len(cell)), channel] = sign * onsets[channel]
    new = time[cell] + share * (time[cell + 1] - time[cell])
    return np.insert(time, cell + 1, new), np.insert(signal, cell + 1, rows, axis=0)


class PeanoHaselDrive:
    """The law of a model's muscles; the body's stiffness counts beside what the muscle itself opposes."""

    def __init__(self, law: MuscleLaw) -> None:
        muscle = law.muscle()
        own = f"{_BODY}.stiffness"
        self._own_stiffness = muscle.values.get(own, 0.0)
        self._muscle = muscle if own in muscle.parameters else muscle.with_effects(_BODY)

    def contraction(self, voltage: np.ndarray, values: Mapping[str, float]) -> np.ndarray:
        """Contraction [1] aimed at for voltages [V] of any shape."""
        muscle = self._beside_the_body(values)
        flat = np.ravel(voltage)
        load = np.full(flat.shape, values[PRELOAD])
        strain = muscle.balanced(flat, load, load) / muscle.rest_length
        return values[GAIN] * strain.reshape(np.shape(voltage))

    def onset(self, values: Mapping[str, float]) -> float:
        """Voltage [V] up to which the preload holds the muscle at its full length."""
        return self._beside_the_body(values).onset(values[PRELOAD])

    def _beside_the_body(self, values: Mapping[str, float]) -> Muscle:
        return self._muscle.with_values({f"{_BODY}.stiffness": self._own_stiffness + values[STIFFNESS]})


class DriveChain:
    """Contraction of every muscle for given parameter values; effects act in the order of their stage, then id."""

    def __init__(self, model: Model) -> None:
        effects = [effect for effect in model.effects if isinstance(effect, DriveEffect)]
        self.effects = sorted(effects, key=lambda effect: (effect.stage, effect.id))
        self.channels = model.channels
        self._of_muscle = model.muscle_channels
        self._rest = np.array([muscle.rest_contraction for muscle in model.described.muscles])
        self._response = model.description.muscle_response
        self._between = model.description.numerics.amplitude_curve
        law = model.description.muscle
        self._law = PeanoHaselDrive(law) if law else None
        self._by_law = [column for column, name in enumerate(self.channels) if model.follows_law(name)]
        self._tables = []
        for table in model.tables:
            columns = [self.channels.index(name) for name in table.channels]
            levels = table.levels(model.parameters)
            self._tables.append((columns, levels, [table.name(level) for level in levels], table.onset))

    @property
    def count(self) -> int:
        """How many muscles there are."""
        return len(self._of_muscle)

    @property
    def relaxed(self) -> np.ndarray:
        """Contraction [muscles] when nothing is commanded."""
        return self._rest

    def at_muscles(self, signal: np.ndarray) -> np.ndarray:
        """What drives each muscle [n, muscles], from what is commanded on the channels [n, channels]."""
        return signal[:, self._of_muscle]

    def contraction(
        self,
        schedule: DriveSchedule,
        times: np.ndarray,
        values: dict[str, float],
        effect_values: dict[str, SimpleNamespace],
    ) -> np.ndarray:
        """Contraction [1] [n, muscles] at ascending times [s] [n], its value at rest included.

        schedule: of exactly this body's channels; values: the baseline's response and amplitudes; effect_values: a
        namespace per effect id.
        """
        sharp = self.sharpened(schedule, times, values, effect_values)
        return self.contraction_on(schedule, sharp, values, effect_values)[np.searchsorted(sharp, times)]

    def contraction_on(
        self,
        schedule: DriveSchedule,
        times: np.ndarray,
        values: dict[str, float],
        effect_values: dict[str, SimpleNamespace],
    ) -> np.ndarray:
        """The same by way of just these times: right where they are `sharpened`."""
        if self.count == 0:
            return np.zeros((len(times), 0))
        time, signal = self._through(_TO_TARGET, *schedule.sampled(times), values, effect_values)
        onsets = self._onsets(values)
        time, signal = with_onsets(time, signal, onsets, crossings(time, signal, onsets))
        time, signal = self._through(_FROM_TARGET, time, self._target(signal, values), values, effect_values)
        series = [np.interp(times, time, signal[:, muscle]) for muscle in range(self.count)]
        return self._rest + np.stack(series, axis=1)

    def sharpened(
        self,
        schedule: DriveSchedule,
        times: np.ndarray,
        values: dict[str, float],
        effect_values: dict[str, SimpleNamespace],
    ) -> np.ndarray:
        """These times [s] and, where the drive follows the command by and by, those at which it passes an onset."""
        if not self._follows(effect_values):
            return times
        onsets = self._onsets(values)
        soon = soon_after_switches(schedule, onsets)
        times = np.union1d(times, soon[(soon > times[0]) & (soon < times[-1])])
        for _ in range(_SECANTS):
            origin, command = schedule.sampled(times)
            time, signal = self._through(_TO_TARGET, origin, command, values, effect_values)
            nearer = secants(crossings(time, signal, onsets), origin)
            if len(nearer) == 0:
                break
            times = np.union1d(times, nearer)
        return times

    def _follows(self, effect_values: dict[str, SimpleNamespace]) -> bool:
        """Whether anything before the target acts on the drive."""
        return self._response == "first_order" or any(
            getattr(effect_values[effect.id], p.name) != p.null
            for effect in self.effects
            if effect.stage < DriveStage.TARGET
            for p in effect.parameters
            if not p.scan
        )

    def _through(
        self,
        stages: Sequence[DriveStage],
        time: np.ndarray,
        signal: np.ndarray,
        values: dict[str, float],
        effect_values: dict[str, SimpleNamespace],
    ) -> tuple[np.ndarray, np.ndarray]:
        for stage in stages:
            if stage == DriveStage.ELECTRODE and self._response == "first_order":
                signal = first_order_lag(time, signal, values["rise_time"], values["fall_time"])
            if stage == DriveStage.CONTRACTION and self._response == "sloped_box":
                signal = limit_rate(time, signal, values["slope"])
            for effect in self.effects:
                if effect.stage == stage:
                    p: SimpleNamespace = effect_values[effect.id]
                    signal = guarded(effect, "respond", time, signal, p)
                    time = guarded(effect, "clock", time, p)
        return time, signal

    def _onsets(self, values: dict[str, float]) -> np.ndarray:
        """Magnitude [channels] up to which a drive contracts nothing."""
        found = np.zeros(len(self.channels))
        if self._law is not None:
            found[self._by_law] = self._law.onset(values)
        for columns, _, _, onset in self._tables:
            found[columns] = values.get(onset, 0.0)
        return found

    def _target(self, signal: np.ndarray, values: dict[str, float]) -> np.ndarray:
        """Contraction aimed at [n, muscles] for a drive [n, channels]."""
        aimed = np.zeros_like(signal, dtype=float)
        if self._law is not None:
            aimed[:, self._by_law] = self._law.contraction(signal[:, self._by_law], values)
        for columns, levels, names, onset in self._tables:
            amplitudes = np.array([values[name] for name in names])
            aimed[:, columns] = target_contraction(
                signal[:, columns], levels, amplitudes, values.get(onset, 0.0), self._between
            )
        return aimed[:, self._of_muscle]
