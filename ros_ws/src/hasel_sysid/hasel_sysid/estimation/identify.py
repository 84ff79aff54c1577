# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Identification as a user asks for it: a fit by a named method, with honest standard errors.

The seed paper's method: Adam on the mean squared error, 0.05 for amplitudes and 0.005 for the slope.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from hasel_common.names import nearest_name
from hasel_common.progress import Stage
from hasel_sim.model import Model

from hasel_sysid.errors import SysidError
from hasel_sysid.estimation.fit import FittedModel, fit_baseline, fitted_model, refined
from hasel_sysid.expected_work import FIT
from hasel_sysid.problem import Problem

_AMPLITUDE_RATE, _OTHER_RATE = 0.05, 0.005


def fit_adam(problem: Problem, model: Model, steps: int = 100) -> FittedModel:
    """Fit by gradient descent, kept for comparison; the default method needs a tenth of its simulations.

    The learning rates act on values in units of their start, as the paper's normalised parameters do; the best of
    all steps is returned.
    """
    work = steps * problem.work(model, model.free)
    with problem.workload.stage(replace(FIT, work=work, known=True)), problem.workload.stage(Stage("Adam")):
        return _fit_adam(problem, model, steps)


def _fit_adam(problem: Problem, model: Model, steps: int) -> FittedModel:
    import torch  # takes seconds and 200 MB, which no other method needs

    names = model.free
    start = np.array([model.parameters[name].value for name in names])
    unit = np.where(start != 0, np.abs(start), 1.0)
    groups = [torch.tensor(value, dtype=torch.float64, requires_grad=True) for value in start / unit]
    rates = [_AMPLITUDE_RATE if name.startswith("amplitude_") else _OTHER_RATE for name in names]
    optimiser = torch.optim.Adam([{"params": [g], "lr": r} for g, r in zip(groups, rates, strict=True)])
    best = None
    for _ in range(steps):
        values = {name: g.item() * u for name, g, u in zip(names, groups, unit, strict=True)}
        inside = {
            name: float(np.clip(value, model.parameters[name].lower, model.parameters[name].upper))
            for name, value in values.items()
        }
        evaluation = problem.evaluate(model.with_values(inside), names)
        if best is None or evaluation.sum_of_squares < best.sum_of_squares:
            best = evaluation
        gradient = -2 * evaluation.jacobian.T @ evaluation.residual / len(evaluation.residual)
        for g, slope, u in zip(groups, gradient, unit, strict=True):
            g.grad = torch.tensor(slope * u, dtype=torch.float64)
        optimiser.step()
    if best is None:
        raise SysidError(f"{steps} steps of Adam find nothing; expected one at least")
    return replace(fitted_model(best, steps), method="Adam (the seed paper's procedure)")


METHODS: dict[str, Callable[..., FittedModel]] = {"least_squares": fit_baseline, "adam": fit_adam}
"""Ways to fit, by the name that `fit --method` takes."""


def identify(problem: Problem, model: Model, method: str = "least_squares") -> FittedModel:
    """Fit the model's free parameters; the standard errors hold noise, scatter between runs and discretisation.

    Raises SysidError for an unknown method, SimulationError when no start can be simulated.
    """
    if method not in METHODS:
        raise SysidError(f"unknown method '{method}'; {nearest_name(method, METHODS)}")
    return refined(problem, METHODS[method](problem, model))
