"""Parameters that every body with muscles has, at their first guesses."""

from collections.abc import Iterable, Mapping

import numpy as np

from hasel_sim.drive.amplitudes import AmplitudeTable
from hasel_sim.model.description import Description
from hasel_sim.model.muscle_law import law_parameters
from hasel_sim.model.parameter import Parameter

_AMPLITUDE_START = 0.04
"""Contraction at which the highest level of a drive is first tried."""
_START_VOLTAGE = 5500.0
"""Voltage [V] of a Peano-HASEL at which that contraction is a good first guess."""
_RESPONSES = {
    "sloped_box": (("slope", 0.5, "1/s", 0.02, 50.0),),
    "first_order": (("rise_time", 0.05, "s", 0.0, 2.0), ("fall_time", 0.05, "s", 0.0, 2.0)),
}


def response_parameters(description: Description) -> dict[str, Parameter]:
    """What a body with muscles always has besides its amplitudes: how fast the contraction follows, and its law's."""
    if not description.muscles:
        return {}
    response = {row[0]: Parameter(*row) for row in _RESPONSES[description.muscle_response]}
    return {**law_parameters(), **response} if description.muscle else response


def amplitude_parameters(
    tables: Iterable[AmplitudeTable], levels, known: Mapping[str, Parameter]
) -> dict[str, Parameter]:
    """An amplitude of every table for each level, those that are known as they are.

    levels: of every channel in its SI unit, or by the name of a channel for those that contract alike.
    """
    found: dict[str, Parameter] = {}
    for table in tables:
        if isinstance(levels, Mapping):
            own = np.unique(np.concatenate([[], *(levels[c] for c in table.channels if c in levels)]))
        else:
            own = np.unique(levels)
        for level in own:
            name = table.name(level)
            highest = _START_VOLTAGE if table.unit == "V" else float(own[-1])
            start = Parameter(name, _AMPLITUDE_START * float(level) / highest, "1", 0.0, table.largest)
            found[name] = known.get(name, start)
    return found
