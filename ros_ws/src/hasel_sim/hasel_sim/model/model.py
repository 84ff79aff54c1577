"""The model: a validated description, its effects and its parameters; never changed, only copied with changes."""

from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np
from pydantic import ValidationError

from hasel_sim.effects.base import Effect
from hasel_sim.effects.registry import find_effects
from hasel_sim.errors import ModelError, nearest_name
from hasel_sim.model.description import Description, Numerics
from hasel_sim.model.parameter import Parameter

_AMPLITUDE_START_PER_VOLT = 0.04 / 5500.0


def _amplitude(level: float) -> Parameter:
    return Parameter(f"amplitude_{level:g}", _AMPLITUDE_START_PER_VOLT * float(level), "1", 0.0, 0.6)


@dataclass(frozen=True)
class Model:
    """description: what the file says; effects: in the file's order; parameters: by name.

    Baseline parameters are `slope` [1/s] and one `amplitude_<voltage>` [1] per voltage; an effect's are `<id>.<name>`.
    """

    description: Description
    effects: tuple[Effect, ...] = ()
    parameters: dict[str, Parameter] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The model's name."""
        return self.description.name

    @property
    def has_muscles(self) -> bool:
        """Whether voltages move this body."""
        return self.description.muscle is not None

    @property
    def has_spine(self) -> bool:
        """Whether a spine runs through this body."""
        return self.description.body.kind == "swimmer"

    @property
    def levels(self) -> np.ndarray:
        """Voltages [V] with an amplitude of their own, ascending."""
        names = [name for name in self.parameters if name.startswith("amplitude_")]
        return np.sort(np.array([float(name.removeprefix("amplitude_")) for name in names]))

    @property
    def values(self) -> dict[str, float]:
        """Value of every parameter."""
        return {name: parameter.value for name, parameter in self.parameters.items()}

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the parameters that a fit may change."""
        return tuple(name for name, parameter in self.parameters.items() if parameter.free)

    def effect_values(self, values: dict[str, float] | None = None) -> dict[str, SimpleNamespace]:
        """One namespace of parameter values per effect id."""
        values = values or self.values
        return {
            effect.id: SimpleNamespace(**{p.name: values[f"{effect.id}.{p.name}"] for p in effect.parameters})
            for effect in self.effects
        }

    def parameter(self, name: str) -> Parameter:
        """One parameter. Raises ModelError for an unknown name."""
        if name not in self.parameters:
            raise ModelError(
                f"'{name}' is not a parameter of model '{self.name}'; {nearest_name(name, self.parameters)}"
            )
        return self.parameters[name]

    def with_values(
        self, values: dict[str, float], standard_errors: dict[str, float | None] | None = None
    ) -> "Model":
        """A copy with other parameter values. Raises ModelError for an unknown name.

        standard_errors: None for a parameter that is not determined; those not named keep theirs.
        """
        parameters = dict(self.parameters)
        for name, value in values.items():
            error = (standard_errors or {}).get(name, self.parameter(name).standard_error)
            parameters[name] = replace(self.parameter(name), value=float(value), standard_error=error)
        return replace(self, parameters=parameters)

    def with_levels(self, levels: np.ndarray) -> "Model":
        """A copy with an amplitude for each of these voltages [V]; known ones keep their value, others are dropped."""
        kept = {name: p for name, p in self.parameters.items() if not name.startswith("amplitude_")}
        new = [_amplitude(level) for level in np.sort(levels)]
        amplitudes = {p.name: self.parameters.get(p.name, p) for p in new}
        return replace(self, parameters={**amplitudes, **kept})

    def with_effects(self, *names: str) -> "Model":
        """A copy with further effects at their null values. Raises ModelError for unknown, duplicate or unfit ones."""
        effects = (*self.effects, *find_effects(names))
        check_together(effects, self)
        parameters = dict(self.parameters)
        for effect in effects[len(self.effects) :]:
            for p in effect.parameters:
                start = p.scan[len(p.scan) // 2] if p.scan else p.null
                parameters[f"{effect.id}.{p.name}"] = Parameter(
                    f"{effect.id}.{p.name}", start, p.unit, p.lower, p.upper
                )
        return replace(self, effects=effects, parameters=parameters)

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
        return replace(self, effects=effects, parameters=parameters)

    def with_numerics(self, **changes: float) -> "Model":
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


def check_together(effects: tuple[Effect, ...], model: Model) -> None:
    """Refuse effects that cannot stand side by side, or not on this body, with a ModelError."""
    seen: dict[str, str] = {}
    for effect in effects:
        for word in filter(None, (effect.id, effect.exclusive)):
            if word in seen:
                reason = "is there twice" if seen[word] == effect.id else f"does the same as '{seen[word]}'"
                raise ModelError(
                    f"effect '{effect.id}' {reason}; expected one of each kind: remove one of the two"
                )
            seen[word] = effect.id
        if effect.needs_muscles and not model.has_muscles:
            raise ModelError(
                f"effect '{effect.id}' acts on the muscles, and model '{model.name}' has none; "
                "remove it or use a model with a muscle section"
            )
        if effect.needs_spine and not model.has_spine:
            raise ModelError(
                f"effect '{effect.id}' acts on the spine, and model '{model.name}' has none; "
                "remove it or use a model whose body is a swimmer"
            )
