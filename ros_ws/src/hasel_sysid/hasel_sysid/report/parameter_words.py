"""What a parameter means and which values are plausible, for whoever reads the table."""

from hasel_sim.effects.base import Effect, EffectParameter
from hasel_sim.model import Model, Parameter

_BASELINE = {
    "amplitude": "share by which a muscle shortens at {} of its drive",
    "onset": "drive up to which a muscle does not contract",
    "slope": "fastest change of that share",
    "rise_time": "time constant with which the drive takes hold",
    "fall_time": "time constant with which it lets go",
    "muscle.stiffness": "force with which the body resists a contraction of the muscle by its whole length",
    "muscle.preload": "pull on the muscle at rest",
    "muscle.gain": "contraction of the fibres by that of the muscle",
}


def meaning(name: str, model: Model) -> str:
    """In words; empty where the name says it."""
    declared = _declared(name, model)
    if declared is not None:
        effect, parameter = declared
        return f"{parameter.symbol} of {effect.id}"
    if model.is_amplitude(name):
        return _BASELINE["amplitude"].format(name.rpartition("_")[2])
    if model.is_onset(name):
        return _BASELINE["onset"]
    return _BASELINE.get(name, "")


def plausible(name: str, model: Model) -> str:
    """Range and source of an effect's parameter; the bounds of any other that has some."""
    declared = _declared(name, model)
    if declared is not None:
        return of_effect(declared[1])
    parameter: Parameter = model.parameters[name]
    if abs(parameter.lower) == float("inf") or abs(parameter.upper) == float("inf"):
        return ""
    return f"{parameter.lower:g} to {parameter.upper:g}"


def of_effect(parameter: EffectParameter) -> str:
    """Plausible range of an effect's parameter, with its source."""
    source = f" ({parameter.source})" if parameter.source else ""
    return f"{parameter.lower:g} to {parameter.upper:g}{source}"


def beyond(parameter: EffectParameter, value: float) -> str:
    """A remark on a found value outside what is plausible, or outside what its source calls usual; else empty."""
    plausible_range = (parameter.lower, parameter.upper)
    for (low, high), what in ((plausible_range, "plausible"), (parameter.usual or plausible_range, "usual")):
        if not low <= value <= high:
            return f"{'below' if value < low else 'above'} the {low:g} to {high:g} that are {what}"
    return ""


def remark(name: str, model: Model) -> str:
    """The same of a model's parameter; empty for one that is of no effect, or does nothing."""
    declared = _declared(name, model)
    value = model.parameters[name].value
    return "" if declared is None or value == declared[1].null else beyond(declared[1], value)


def _declared(name: str, model: Model) -> tuple[Effect, EffectParameter] | None:
    identity, _, own = name.rpartition(".")
    for effect in model.effects:
        if effect.id == identity:
            return effect, next(p for p in effect.parameters if p.name == own)
    return None
