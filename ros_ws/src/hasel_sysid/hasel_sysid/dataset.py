# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Recordings read as experiments, those that can be simulated, with the channels and levels of a model."""

import warnings
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import replace
from pathlib import Path

import numpy as np
from hasel_common.names import nearest
from hasel_recording import DriveChannel, Recording, RecordingError, RecordingWarning, read_recordings
from hasel_recording.plateaus import FINEST, roundest
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.parallel import submit_all

from hasel_sysid.data_quality import refusal
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment, counted_once, experiment_of

_FAR_BEYOND = 1.25
"""A level this many times the highest known one is not extrapolated to."""
_OTHER_UNIT = 300.0
"""A level this many times the highest known one tells of a level in thousands, such as kV."""
_MOST_LEVELS = 8
"""More voltages than this (a ramp, a sine) share so many amplitudes, spread over their range."""


def model_channels(model: Model) -> tuple[DriveChannel, ...]:
    """What drives a model's body, as a recording knows it; empty for a passive one."""
    return tuple(channel.column for channel in model.description.channels)


def matched(model: Model, recordings: Sequence[Recording]) -> list[Recording]:
    """The recordings with exactly the model's channels, in its order.

    A channel that the model has not got and that is zero throughout is left out with one RecordingWarning for all.
    Raises SysidError for one that is not zero, for a channel of the model that a recording has not got, and for one
    of another quantity.
    """
    wanted = model_channels(model)
    left_out = Counter(
        name for recording in recordings for name in _unused_channels(model, wanted, recording)
    )
    for name, count in left_out.items():
        where = recordings[0].name if len(recordings) == 1 else f"{count} of {len(recordings)} recordings"
        warnings.warn(
            f"channel '{name}' is zero throughout in {where} and drives nothing in model '{model.name}': left out.",
            RecordingWarning,
            stacklevel=3,
        )
    return [_chosen(recording, wanted) for recording in recordings]


def check_levels(model: Model, recordings: Sequence[Recording]) -> None:
    """Raise SysidError where a recording that matches the model drives it too hard.

    Too hard is more than the model file's `largest` of a channel, and far beyond the levels whose amplitudes a model
    knows: beyond the highest the contraction goes on with the slope it has there, which is 4 % short of a quadratic law
    at a quarter more, and worse further out.
    """
    for recording in recordings:
        if not recording.driven:
            continue
        strongest = np.abs(recording.drive()[1]).max(axis=0)
        for channel, own, level in zip(
            model.description.channels, recording.channels, strongest, strict=True
        ):
            if channel.largest is not None and level > channel.largest:
                raise SysidError(
                    f"{recording.name} drives '{own.name}' with {own.shown(level)}, and model '{model.name}' allows "
                    f"{own.shown(channel.largest)}: is the column in {own.unit}? Otherwise raise `largest` in the "
                    "model file"
                )
            table = model.table_of(own.name)
            if table is None:  # a law knows every level
                continue
            known = table.levels(model.parameters)
            if len(known) and level > _FAR_BEYOND * known[-1]:
                levels = ", ".join(f"{each:g}" for each in known)
                if level > _OTHER_UNIT * known[-1]:
                    raise SysidError(
                        f"{recording.name} drives '{own.name}' with {own.shown(level)}, and model '{model.name}' knows "
                        f"{levels} {own.unit}: is {table.name(1e3 * known[-1])} meant where the model file says "
                        f"{table.name(known[-1])}? Amplitudes are named by the level in {own.unit}"
                    )
                raise SysidError(
                    f"{recording.name} drives '{own.name}' with {own.shown(level)}, far beyond the levels that model "
                    f"'{model.name}' knows ({levels} {own.unit}): fit it on a run at about that level, or leave this "
                    "one out"
                )


def _chosen(recording: Recording, wanted: tuple[DriveChannel, ...]) -> Recording:
    if not recording.driven or recording.channels == wanted:
        return recording
    if not wanted:
        return replace(recording, drive_signal=None, drive_time_s=None, drive_values=None)
    columns = [recording.channels.index(channel) for channel in wanted]

    def chosen(signal: np.ndarray | None) -> np.ndarray | None:
        return None if signal is None else signal[:, columns]

    return replace(
        recording,
        channels=wanted,
        drive_signal=chosen(recording.drive_signal),
        drive_values=chosen(recording.drive_values),
    )


def _unused_channels(model: Model, wanted: tuple[DriveChannel, ...], recording: Recording) -> list[str]:
    """Names of the channels that are zero throughout and that the model has not got; SysidError for what cannot be."""
    if not recording.driven:
        if wanted:
            raise SysidError(
                f"{recording.name} has no drive, and model '{model.name}' is driven by {_with_units(wanted)}: add the "
                f"columns {_columns(wanted)} (zeros where nothing drives), give --drive FILE, or choose another --model"
            )
        return []
    _, values = recording.drive()
    by_name = {channel.name: channel for channel in wanted}
    unused = []
    for channel, signal in zip(recording.channels, values.T, strict=True):
        if channel in wanted:
            continue
        if channel.name not in by_name and not signal.any():
            unused.append(channel.name)
        elif channel.name in by_name:
            raise SysidError(
                f"{recording.name} gives a {channel.quantity} for '{channel.name}', and model '{model.name}' expects a "
                f"{by_name[channel.name].quantity}: name the column {by_name[channel.name].column}, say "
                "#volts_per_<unit> in the header where volts stand for it, or choose another --model"
            )
        else:
            raise SysidError(_without_a_muscle(model, wanted, recording, channel))
    for channel in wanted:
        if channel not in recording.channels:
            raise SysidError(
                f"{recording.name} has no column for channel '{channel.name}' of model '{model.name}', only "
                f"{_columns(recording.channels)}: add {channel.column} (zeros where it rests) or choose another --model"
            )
    return unused


def _without_a_muscle(
    model: Model, wanted: tuple[DriveChannel, ...], recording: Recording, channel: DriveChannel
) -> str:
    if not wanted:
        return (
            f"{recording.name} is driven ({channel.column}), and model '{model.name}' has no muscles; choose the model "
            "with --model (swimmer is the default)"
        )
    near = nearest(channel.name, [other.name for other in wanted], similarity=0.6)
    hint = f"is '{near}' meant? Then rename the column" if near else "rename or remove the column"
    return (
        f"{recording.name} drives channel '{channel.name}' ({channel.column}), which contracts no muscle of model "
        f"'{model.name}'; expected {_with_units(wanted)}: {hint}, or choose another --model"
    )


def _with_units(channels: Sequence[DriveChannel]) -> str:
    return ", ".join(f"{channel.name} [{channel.unit}]" for channel in channels)


def _columns(channels: Sequence[DriveChannel]) -> str:
    return ", ".join(channel.column for channel in channels)


def load_experiments(
    paths: Iterable[str | Path],
    mapping: Mapping[str, str] | str | None = None,
    drives: Sequence[str | Path | None] | None = None,
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
