"""The truth of the virtual rig: a model with effects that the user is to find."""

from collections.abc import Sequence

from hasel_sim.errors import ModelError
from hasel_sim.model import Model


def with_hidden(model: Model, settings: Sequence[str]) -> Model:
    """The model with parameters set as "name=value"; an effect named before the dot is added first.

    Raises ModelError for a setting that is not understood or out of the parameter's range.
    """
    for setting in settings:
        name, separator, text = setting.partition("=")
        try:
            value = float(text)
        except ValueError:
            separator = ""
        if not separator:
            raise ModelError(
                f"'{setting}' is no setting; expected name=value such as quadratic_drag.coefficient=0.25"
            )
        effect = name.rpartition(".")[0]
        if effect and effect not in {known.id for known in model.effects}:
            model = model.with_effects(effect)
        parameter = model.parameter(name)
        if not parameter.lower <= value <= parameter.upper:
            raise ModelError(
                f"{name} = {value:g} {parameter.unit} is out of range; expected {parameter.lower:g} to "
                f"{parameter.upper:g}"
            )
        model = model.with_values({name: value})
    return model
