"""Which constants of a model file are worth a fit, on the simulator."""

from collections.abc import Iterator

import numpy as np
import pytest
from hasel_sim.model import Model, load_model
from hasel_sysid.estimation import fit_baseline, fit_least_squares, is_close
from hasel_sysid.estimation.decades import decades
from hasel_sysid.improvement.constants_looked_at import beside_what_is_far_off
from hasel_sysid.improvement.freed_constant import freed, held_constants
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Problem
from hasel_sysid.testing.simulated_runs import simulated_runs

DENSITY = "material.density_kg_per_m3"


def _body():
    model = load_model("swimmer").with_levels([3500.0, 5500.0])
    return model.with_numerics(mesh_density=0.7, quadrature_order=2, steps_per_second=240.0)


def _measured(share: float) -> Problem:
    """Runs of a body that is so many times as dense."""
    truth = _body().with_values({"amplitude_3500": 0.03, "amplitude_5500": 0.05}).with_freed(DENSITY)
    truth = truth.with_values({DENSITY: 900.0 * share})
    drives = (3500.0, 0.5), (3500.0, 2.0), (5500.0, 1.0), (5500.0, 3.5)
    return simulated_runs(truth, drives, np.arange(0.0, 2.0, 1 / 60))


def values_over_decades(model: Model) -> Iterator[float]:
    """Of all constants."""
    for name in held_constants(model):
        yield from decades(freed(model, name), name)


@pytest.mark.parametrize(("share", "fewer"), [(0.5, POLICY.effort.fits), (2.0, 0)])
def test_a_wrong_density_is_found_from_afar(share, fewer):
    """No first order leads there from the file's value; over its range it comes near, and a fit goes the rest.

    Beside twice the density the muscles are fitted at a tenth of their amplitude: it is seen from the given one. Where
    much else promises something, more of it is fitted than beside a model that is close.
    """
    problem, given = _measured(share), _body()
    fitted = fit_baseline(problem, given).evaluation
    assert not is_close(fitted)
    problem.evaluations = 0
    begin = beside_what_is_far_off(problem, fitted, POLICY, given)
    assert DENSITY in begin
    assert len(begin) > fewer
    # every run is simulated for what comes nearer only: beside the fitted model and the given one
    assert problem.evaluations < 2 * len(list(values_over_decades(given)))
    found = fit_least_squares(problem, begin[DENSITY], drafts=False)
    assert found.model.values[DENSITY] == pytest.approx(900.0 * share, rel=0.01)
    assert found.evaluation.sum_of_squares < 1e-3 * fitted.sum_of_squares
