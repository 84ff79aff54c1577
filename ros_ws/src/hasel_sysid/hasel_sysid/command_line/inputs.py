# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What commands on recordings begin with: the runs and the model."""

import argparse
from collections.abc import Collection, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from hasel_recording import Recording
from hasel_recording.reading import distinct_names, drive_of_each
from hasel_sim.errors import OwnCodeError
from hasel_sim.model import Model, load_model

from hasel_sysid.candidates import named_effects
from hasel_sysid.command_line.options import DEFAULT_MODEL
from hasel_sysid.command_line.shown import announce
from hasel_sysid.data_quality import DataFinding
from hasel_sysid.dataset import check_levels, for_model, load_experiments, prepared, simulable
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import GENTLEST, Experiment, check_unseen

if TYPE_CHECKING:
    from hasel_sysid.noise import NoiseModel


def chosen_model(asked: str | None, recordings: Sequence[Recording]) -> tuple[str, Model]:
    """What to call the model, and the model. Raises SysidError where code would run that --model did not ask for."""
    named = {recording.metadata.get("model") for recording in recordings}
    name = asked or (named.pop() if len(named) == 1 else None) or DEFAULT_MODEL
    try:
        model = load_model(name, own_code=bool(asked))
    except OwnCodeError as error:
        raise SysidError(f"named by the recordings, {error}: give --model {name} if that is meant") from None
    return Path(name).stem if Path(name).suffix in (".yaml", ".yml") else name, model


@dataclass(frozen=True)
class Inputs:
    """experiments: to fit; unseen: never fitted; model: with an amplitude for every fitted voltage; label: its name;
    said: findings of the data gate that were told already; noise: of the measured angle, where it was given.
    """

    experiments: list[Experiment]
    unseen: list[Experiment]
    label: str
    model: Model
    said: list[DataFinding]
    noise: "NoiseModel | None" = None


def load_inputs(options: argparse.Namespace, decided_later: Collection[str] = ()) -> Inputs:
    """Read the recordings, tell what the data gate finds but for what is `decided_later`, and choose the model.

    Raises ModelError for an effect of --effects or --add that is not known.
    """
    named_effects(getattr(options, "effects", None))
    experiments, unseen = load_all(options)
    noise = _noise(getattr(options, "noise", None))
    label, model = chosen_model(options.model, [each.recording for each in (*experiments, *unseen)])
    every = for_model(model.with_levels([]), [*experiments, *unseen])
    experiments, unseen = every[: len(experiments)], every[len(experiments) :]
    said = announce(every, decided_later)
    model = prepared(model, experiments)
    check_levels(model, [each.recording for each in unseen])
    return Inputs(experiments, unseen, label, model, said, noise)


def that_can_be_simulated(given: Inputs, pool: Executor) -> Inputs:
    """The inputs without runs that the model cannot follow, of which a note tells."""
    fitted, unseen = (simulable(given.model, e, pool, GENTLEST) for e in (given.experiments, given.unseen))
    return replace(given, experiments=fitted, unseen=unseen)


def _noise(given: float | None) -> "NoiseModel | None":
    if given is None:
        return None
    from hasel_sysid.noise import (
        given_noise,  # takes as long to import as all else that compare needs
    )

    return given_noise(given)


def load_all(options: argparse.Namespace) -> tuple[list[Experiment], list[Experiment]]:
    """The experiments to fit and the unseen ones.

    Raises RecordingError when there are none to read, SysidError where one is both.
    """
    fitted, validated = list(options.recordings), list(options.validate)
    drives = drive_of_each([*fitted, *validated], options.drive)
    names, count = distinct_names([*fitted, *validated]), len(fitted)
    experiments = load_experiments(fitted, options.map, drives[:count], names[:count])
    unseen = load_experiments(validated, options.map, drives[count:], names[count:]) if validated else []
    check_unseen(unseen, experiments)
    return experiments, unseen
