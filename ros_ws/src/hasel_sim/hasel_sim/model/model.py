# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The model: a validated description, its effects and its parameters; never changed, only copied with changes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import SimpleNamespace
from typing import Any

import numpy as np
from hasel_common.names import nearest_name
from pydantic import ValidationError

from hasel_sim.drive.amplitudes import AmplitudeTable, amplitude_tables
from hasel_sim.effects.base import Effect
from hasel_sim.effects.registry import find_effects
from hasel_sim.errors import ModelError
from hasel_sim.model.description import Description, check_together
from hasel_sim.model.model_parameters import (
    amplitude_parameters,
    constants,
    onset_parameters,
    sweeps,
    unit_of,
    with_constants,
)
from hasel_sim.model.sections import Numerics
from hasel_sim.model.validation import sentence_for
from hasel_sim.parameter import (
    Parameter,
    Parametrised,
    parameters_of,
    values_of,
)


@dataclass(frozen=True)
class Model(Parametrised):
    """description: what the file says; effects: in the file's order; parameters: by name.

    Baseline parameters are `slope` [1/s] (or `rise_time` and `fall_time` [s]) and one `amplitude_<level>` [1] per level
    of the drive; an effect's are `<id>.<name>`; a constant of the file that is freed is called by its path, such as
    `material.soft.youngs_modulus_pa`. Where the drive passes levels that nobody commanded there is an `onset` [V], up
    to which nothing contracts. Where muscles follow a law it has `muscle.<name>` in place of amplitudes, and
    law_levels are the voltages [V] it was last used at.
    """

    description: Description
    effects: tuple[Effect, ...] = ()
    parameters: dict[str, Parameter] = field(default_factory=dict)
    law_levels: tuple[float, ...] = ()

    @property
    def name(self) -> str:
        """The model's name."""
        return self.description.name

    @property
    def has_muscles(self) -> bool:
        """Whether anything drives this body."""
        return bool(self.description.muscles)

    @property
    def has_spine(self) -> bool:
        """Whether a spine runs through this body."""
        return self.description.body.spine is not None

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels that drive this body, in the file's order."""
        return tuple(channel.name for channel in self.description.channels)

    @property
    def muscle_channels(self) -> np.ndarray:
        """Number of the channel that contracts each muscle, [muscles]."""
        return np.array([self.channels.index(m.channel) for m in self.description.muscles], dtype=int)

    @cached_property
    def tables(self) -> tuple[AmplitudeTable, ...]:
        """Which channels contract alike, and how their amplitudes are called."""
        return amplitude_tables(tuple(c for c in self.description.channels if not self.follows_law(c.name)))

    def follows_law(self, channel: str) -> bool:
        """Whether a law says what this channel contracts, and not a table."""
        quantity = self.description.channels[self.channels.index(channel)].quantity
        return self.description.muscle is not None and quantity == "voltage"

    def table_of(self, channel: str) -> AmplitudeTable | None:
        """The table that a channel's amplitudes are in; None where it follows a law."""
        return next((table for table in self.tables if channel in table.channels), None)

    @property
    def levels(self) -> np.ndarray:
        """Levels of all drives with an amplitude of their own, or used with a law, ascending, each in its own unit."""
        found = [np.array(self.law_levels), *(table.levels(self.parameters) for table in self.tables)]
        return np.sort(np.concatenate(found))

    @cached_property
    def described(self) -> Description:
        """The description with the freed constants at their parameters' values."""
        known = constants(self.description)
        freed = {name: p.value for name, p in self.parameters.items() if name in known}
        return with_constants(self.description, freed) if freed else self.description

    @property
    def drive_unit(self) -> str:
        """Unit of everything that drives the body; empty where units differ or nothing does."""
        units = {channel.unit for channel in self.description.channels}
        return units.pop() if len(units) == 1 else ""

    def effect_values(self, values: dict[str, float] | None = None) -> dict[str, SimpleNamespace]:
        """One namespace of parameter values per effect id."""
        values = values or self.values
        return {effect.id: values_of(effect, values) for effect in self.effects}

    def parameter(self, name: str) -> Parameter:
        """One parameter. Raises ModelError for an unknown name."""
        if name not in self.parameters:
            raise ModelError(
                f"'{name}' is not a parameter of model '{self.name}'; {nearest_name(name, self.parameters)}"
            )
        return self.parameters[name]

    def with_amplitudes_times(self, share: float) -> "Model":
        """The model with all its amplitudes times a share."""
        return self.with_values(
            {name: share * v for name, v in self.values.items() if self.is_amplitude(name)}
        )

    def with_freed(self, *names: str) -> "Model":
        """A copy in which these constants of the file are parameters, at the file's values.

        Raises ModelError for a name that is neither a constant nor a parameter.
        """
        known, freed = constants(self.description), dict(self.parameters)
        for name in names:
            if name in freed:
                continue
            if name not in known:
                raise ModelError(
                    f"'{name}' is neither a parameter nor a constant of model '{self.name}'; "
                    f"{nearest_name(name, {*freed, *known})}"
                )
            freed[name] = Parameter(name, known[name], unit_of(name))
        return replace(self, parameters=freed)

    def with_constants_settled(self, *names: str) -> "Model":
        """A copy whose file itself has these constants at their values, which are then no parameters any more.

        Its mesh is made for its shape as it is then. Raises ModelError where that does not fit together.
        """
        settled = with_constants(self.description, {name: self.parameter(name).value for name in names})
        description = _validated(settled.model_dump())
        parameters = {name: p for name, p in self.parameters.items() if name not in names}
        return replace(self, description=description, parameters=parameters)

    def with_levels(self, levels: np.ndarray | Sequence[float] | Mapping[str, np.ndarray]) -> "Model":
        """A copy with an amplitude for each of these levels; known ones keep their value, others are dropped.

        levels: of every channel in its SI unit, or by the name of a channel for those that contract alike.
        """
        amplitudes = amplitude_parameters(self.tables, levels, self.parameters)
        kept = {name: p for name, p in self.parameters.items() if not self.is_amplitude(name)}
        lawful = [
            levels.get(name, []) if isinstance(levels, Mapping) else levels
            for name in self.channels
            if self.follows_law(name)
        ]
        seen = tuple(float(level) for level in np.unique(np.concatenate([[], *lawful])))
        return replace(self, parameters={**amplitudes, **kept}, law_levels=seen).with_onsets()

    def is_amplitude(self, name: str) -> bool:
        """Whether a parameter's name is that of an amplitude of this body."""
        return any(table.level(name) is not None for table in self.tables)

    def is_onset(self, name: str) -> bool:
        """Whether a parameter's name is that of an onset of this body."""
        return name in self.onset_units

    @property
    def onset_units(self) -> dict[str, str]:
        """Names of the onsets that this body can have, and their units."""
        return {table.onset: table.unit for table in self.tables}

    def with_onsets(self) -> "Model":
        """A copy with a parameter for the onset of the muscles exactly where the drive passes unknown levels."""
        rest = {name: p for name, p in self.parameters.items() if not self.is_onset(name)}
        found = {}
        if sweeps(self.description, self.effects):
            found = onset_parameters(self.tables, self.parameters)
        return replace(self, parameters={**rest, **found})

    def with_effects(self, *names: str) -> "Model":
        """A copy with further effects at their null values. Raises ModelError for unknown, duplicate or unfit ones."""
        effects = (*self.effects, *find_effects(names))
        check_together(effects, self.description)
        parameters = dict(self.parameters)
        for effect in effects[len(self.effects) :]:
            parameters |= parameters_of(effect)
        return replace(self, effects=effects, parameters=parameters).with_onsets()

    def without_effects(self, *names: str) -> "Model":
        """A copy without some effects and their parameters. Raises ModelError for one that is not there."""
        known = {effect.id for effect in self.effects}
        for name in names:
            if name not in known:
                raise ModelError(
                    f"effect '{name}' is not in model '{self.name}'; {nearest_name(name, known)}"
                )
        effects = tuple(effect for effect in self.effects if effect.id not in names)
        gone = tuple(f"{name}." for name in names)
        parameters = {name: p for name, p in self.parameters.items() if not name.startswith(gone)}
        return replace(self, effects=effects, parameters=parameters).with_onsets()

    def in_medium(self, fluid: str | Mapping[str, float], depth_m: float) -> "Model":
        """A copy of so deep a body in a fluid: a name, or the keys of the file's section medium.

        The fluid does nothing until there are effects of it. Raises ModelError for an unknown fluid or a bad value.
        """
        content = self.description.model_dump()
        content["medium"] = fluid if isinstance(fluid, str) else dict(fluid)
        content["body"]["depth_m"] = depth_m
        return replace(self, description=_validated(content))

    def with_numerics(self, **changes: float | str) -> "Model":
        """A copy with other numerics, such as mesh_density=2 or steps_per_second=960.

        Raises ModelError for an unknown one or a bad value.
        """
        try:
            numerics = Numerics.model_validate({**self.description.numerics.model_dump(), **changes})
        except ValidationError as error:
            problem = error.errors()[0]
            raise ModelError(
                f"numerics.{problem['loc'][0]} is {problem['input']!r}; {problem['msg'].lower()}: correct it"
            ) from None
        return replace(self, description=self.description.model_copy(update={"numerics": numerics}))

    def __str__(self) -> str:
        driven = " and ".join(channel.column.column for channel in self.description.channels)
        effects = ", ".join(effect.id for effect in self.effects)
        held = [name for name, parameter in self.parameters.items() if not parameter.free]
        lines = [
            f"{self.name}: {f'driven by {driven}' if driven else 'passive'}, "
            f"{f'with the effects {effects}' if effects else 'without effects'}.",
            *(f"  {parameter}" for parameter in self.parameters.values() if parameter.free),
            *([f"  held: {', '.join(held)}"] if held else []),
        ]
        return "\n".join(lines)

    def __repr__(self) -> str:
        named = " + ".join([self.name, *(effect.id for effect in self.effects)])
        return f"<Model {named}, {len(self.parameters)} parameters>"


def _validated(content: dict[str, Any]) -> Description:
    try:
        return Description.model_validate(content)
    except ValidationError as error:
        raise ModelError(sentence_for(error)) from None
