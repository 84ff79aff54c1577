"""Recordings read as experiments, those that can be simulated, with the channels and levels of a model."""

import warnings
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from pathlib import Path

import numpy as np
from hasel_recording import Recording, RecordingError, RecordingWarning, read_recordings
from hasel_recording.plateaus import FINEST, roundest
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.parallel import submit_all

from hasel_sysid.data_gate import refusal
from hasel_sysid.drive_match import check_levels, matched
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment, experiment_of
from hasel_sysid.repeated_runs import counted_once

_MOST_LEVELS = 8
"""More voltages than this (a ramp, a sine) share so many amplitudes, spread over their range."""


def load_experiments(
    paths: Iterable[str | Path],
    mapping: Mapping[str, str] | str | None = None,
    drives: Sequence[str | Path] | None = None,
    names: Sequence[str] | None = None,
) -> list[Experiment]:
    """Read recordings (.csv, .mcap) as experiments.

    mapping, drives, names: as of hasel_recording.read_recordings. One among good ones that cannot be read, or not be
    simulated, is skipped with a RecordingWarning; raises RecordingError when none is left.
    """
    return usable(read_recordings(paths, mapping, drives, names))


def usable(recordings: Iterable[Recording]) -> list[Experiment]:
    """The recordings that can be simulated, as experiments; the others are skipped, each with a RecordingWarning, and
    a run that is given twice counts once.

    Raises RecordingError when none is left.
    """
    good, refused = [], []
    for recording in recordings:
        fault = refusal(recording)
        if fault is None:
            good.append(experiment_of(recording))
        else:
            refused.append(str(fault))
    if not good:
        raise RecordingError(" ".join(refused))
    for sentence in refused:
        warnings.warn(f"Skipped: {sentence}", RecordingWarning, stacklevel=2)
    return counted_once(good)


def simulable(
    model: Model, experiments: Sequence[Experiment], pool: Executor, share: float = 1.0
) -> list[Experiment]:
    """The experiments that the model can follow; each other one is skipped with a RecordingWarning.

    share: of the model's amplitudes; `GENTLEST` where a fit is to begin.
    Raises SimulationError where experiments are given and none is left.
    """
    good, refused = [], []
    futures = submit_all(pool, model.with_amplitudes_times(share), [each.run for each in experiments])
    for each, future in zip(experiments, futures, strict=True):
        try:
            future.result()
            good.append(each)
        except SimulationError as error:
            refused.append(f"{each.name} cannot be simulated: {error}")
    if refused and not good:
        raise SimulationError(" ".join(refused))
    for sentence in refused:
        warnings.warn(f"Skipped: {sentence}", RecordingWarning, stacklevel=2)
    return good


def for_model(model: Model, experiments: Sequence[Experiment]) -> list[Experiment]:
    """The experiments with exactly the channels of the model.

    Raises SysidError where channels do not fit, where one is driven beyond what the model file allows, or far beyond
    the levels that the model knows.
    """
    chosen = matched(model, [each.recording for each in experiments])
    check_levels(model, chosen)
    return [
        each if recording is each.recording else experiment_of(recording)
        for each, recording in zip(experiments, chosen, strict=True)
    ]


def drive_levels(experiments: Sequence[Experiment], channels: tuple[str, ...] | None = None) -> np.ndarray:
    """Levels that get an amplitude of their own, ascending: all that occur, or eight spread over many.

    Levels so near that a muscle hardly tells them apart, as of one voltage measured in several runs, share one.
    channels: those that contract alike (default: all).
    """
    found = [e.run.schedule.levels(channels) for e in experiments if e.run.schedule is not None]
    levels = np.concatenate(found) if found else np.zeros(0)
    levels = np.unique([float(f"{level:.5g}") for level in levels])
    alike: list[list[float]] = []
    for level in levels:
        if alike and level < (1.0 + FINEST) * alike[-1][0]:
            alike[-1].append(level)
        else:
            alike.append([level])
    if len(alike) <= _MOST_LEVELS:
        return np.array([roundest(group[0], group[-1]) for group in alike])
    return np.linspace(levels[-1] / _MOST_LEVELS, levels[-1], _MOST_LEVELS)


def prepared(model: Model, experiments: Sequence[Experiment]) -> Model:
    """The model with an amplitude for every level of these experiments; passive models stay as they are.

    Raises SysidError when the experiments are driven and the body has no muscles.
    """
    if not model.has_muscles:
        levels = drive_levels(experiments)
        if len(levels):
            unit = experiments[0].recording.channels[0].unit
            raise SysidError(
                f"the recordings are driven with up to {levels[-1]:g} {unit}, and model '{model.name}' has no muscles; "
                "choose the model with --model (swimmer is the default)"
            )
        return model
    alike = [*(table.channels for table in model.tables), tuple(filter(model.follows_law, model.channels))]
    levels = {channels[0]: drive_levels(experiments, channels) for channels in alike if channels}
    return model.with_levels(levels) if any(len(own) for own in levels.values()) else model
