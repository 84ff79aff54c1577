"""Sizes of what was found, as a person reads them: a value with its interval, or the bound that it is on."""

import math

from hasel_sim.model import Parameter

from hasel_sysid.report.numbers import interval_text
from hasel_sysid.result import Improvement

_ON_BOUND = 1e-6
"""Share of a parameter's range; a fit comes so near a bound that it wants to go beyond."""


def found_values(found: Improvement) -> list[str]:
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
