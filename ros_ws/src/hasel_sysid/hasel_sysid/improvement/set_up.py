"""Faults of the set-up that only a model can show; they come before any physics."""

from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.data_gate import Finding, check_against_model
from hasel_sysid.problem import Problem

_OPPOSED = "sign flip or swapped channels"


def opposed_runs(problem: Problem, model: Model) -> list[Finding]:
    """Runs that move against the model, as it is before any fit: afterwards it may not move at all.

    None is found where the model cannot be simulated yet.
    """
    try:
        simulations = problem.evaluate(model).simulations
    except SimulationError:
        return []
    return [
        finding
        for experiment, simulation in zip(problem.experiments, simulations, strict=True)
        for finding in check_against_model(experiment.recording, simulation.sin_theta)
        if finding.fault == _OPPOSED
    ]
