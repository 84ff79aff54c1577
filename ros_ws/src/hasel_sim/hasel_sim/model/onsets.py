"""The onset of muscles: a parameter wherever the drive passes levels at which no amplitude is known."""

from collections.abc import Iterable, Mapping
from dataclasses import replace

from hasel_sim.drive.amplitudes import LARGEST_ONSET, AmplitudeTable
from hasel_sim.effects.base import DriveEffect, DriveStage, Effect
from hasel_sim.model.description import Description
from hasel_sim.model.parameter import Parameter


def sweeps(description: Description, effects: Iterable[Effect]) -> bool:
    """Whether anything before the target lets the drive pass levels that nobody commanded."""
    return description.muscle_response == "first_order" or any(
        isinstance(effect, DriveEffect) and effect.sweeps and effect.stage < DriveStage.TARGET
        for effect in effects
    )


def onset_parameters(
    tables: Iterable[AmplitudeTable], parameters: Mapping[str, Parameter]
) -> dict[str, Parameter]:
    """One of every table with an amplitude; those that are known as they are, within what its levels allow.

    A new one is at 0, where the model is the same as without it.
    """
    found = {}
    for table in tables:
        levels = table.levels(parameters)
        if len(levels) == 0:
            continue
        new = Parameter(table.onset, 0.0, table.unit, 0.0, float("inf"))
        known, largest = parameters.get(table.onset, new), LARGEST_ONSET * float(levels[0])
        found[table.onset] = replace(known, value=min(known.value, largest), upper=min(known.upper, largest))
    return found
