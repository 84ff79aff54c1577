"""Sizes over the decades of a plausible range, where a search from far away begins."""

import numpy as np
from hasel_sim.model import Model


def decades(model: Model, name: str) -> list[float]:
    """Values of an effect's size or of a constant of the model file over the decades of its plausible range.

    None for a range that is not known, and for muscles, whose amplitudes and times follow from the first swing.
    """
    parameter = model.parameters[name]
    for effect in model.effects:
        for p in effect.parameters:
            if f"{effect.id}.{p.name}" == name:
                return over_range(p.null, p.typical, p.lower, p.upper)
    if "." not in name or not np.isfinite([parameter.lower, parameter.upper]).all():
        return []
    if parameter.lower > 0:
        return [float(v) for v in np.geomspace(parameter.lower, parameter.upper, 7)[1:-1]]
    return (
        [float(v) for v in np.geomspace(1e-3, 1.0, 7)[:-1] * parameter.upper] if parameter.lower == 0 else []
    )


def over_range(null: float, typical: float, lower: float, upper: float) -> list[float]:
    """Sizes over a plausible range: of a ratio, evenly in its logarithm; else from half a decade below the typical size
    outwards by factors of sqrt(10), to either side of the null that the range has.
    """
    step = abs(typical - null)
    if null == 1.0 and lower > 0:
        return [float(v) for v in np.geomspace(lower, upper, 7)[1:-1]]
    if step == 0 or not np.isfinite([lower, upper]).all():
        return [typical]
    found = []
    for side, end in ((-1.0, lower), (1.0, upper)):
        exponent = -0.5
        while side * (end - null) > (size := step * 10.0**exponent):
            found.append(float(null + side * size))
            exponent += 0.5
    return sorted(found)
