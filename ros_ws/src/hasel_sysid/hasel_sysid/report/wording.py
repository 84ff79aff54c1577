# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Numbers, values and parameters in the words in which a reader wants them."""

import math
from typing import TYPE_CHECKING

from hasel_sim.effects.base import Effect, EffectParameter
from hasel_sim.model import Model, Parameter

if TYPE_CHECKING:
    from hasel_sysid.answer.result import Improvement

_NORMAL_95 = 1.96
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
_ON_BOUND = 1e-6
"""Share of a parameter's range; a fit comes so near a bound that it wants to go beyond."""


def error_text(error: float) -> str:
    """An error of sin theta: four decimals, or two digits where these would say nothing."""
    return f"{error:.4f}" if error >= 0.0005 or error == 0 else f"{error:.1e}"


def change_text(change: float) -> str:
    """A change of such an error, with its sign."""
    return ("+" if change > 0 else "−") + error_text(abs(change))


def count_text(count: int, what: str) -> str:
    """A count with its noun, such as 1 run or 3 runs."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def percent(share: float) -> str:
    """A share from 0 to 1 as per cent; a dash when not known."""
    if not math.isfinite(share):
        return "–"
    if 0 < share < 0.0005:
        return "< 0.1 %"
    return f"{100 * share:.0f} %" if share >= 0.0095 or share == 0 else f"{100 * share:.1f} %"


def interval_text(value: float, error: float | None, unit: str) -> str:
    """A value with its unit and its 95 % interval: "0.0624 s (95 % interval 0.0602 to 0.0646)"."""
    suffix = "" if unit == "1" else f" {unit}"
    if error is None or not math.isfinite(error) or error <= 0:
        return f"{value:.4g}{suffix}"
    digits = max(0, 1 - math.floor(math.log10(error)))
    interval = (value, value - _NORMAL_95 * error, value + _NORMAL_95 * error)
    middle, low, high = (f"{each:.{digits}f}" if digits <= 7 else f"{each:.4g}" for each in interval)
    return f"{middle}{suffix} (95 % interval {low} to {high})"


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


def found_values(found: "Improvement") -> list[str]:
    """A line for every parameter of what is missing."""
    parameters = found.model.parameters
    names = [name for name in parameters if name.rpartition(".")[0] in found.missing]
    names += [found.constant.name] if found.constant else []
    return [value_line(parameters[name]) for name in names]


def value_line(parameter: Parameter) -> str:
    """Name, value and 95 % interval."""
    span = parameter.upper - parameter.lower
    for which, bound in (("lower", parameter.lower), ("upper", parameter.upper)):
        if abs(parameter.value - bound) < _ON_BOUND * span < math.inf:
            unit = "" if parameter.unit == "1" else f" {parameter.unit}"
            return f"  {parameter.name} is on its {which} bound, {bound:g}{unit}"
    return f"  {parameter.name} = {interval_text(parameter.value, parameter.standard_error, parameter.unit)}"
