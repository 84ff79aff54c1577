# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Models against runs."""

from concurrent.futures import Executor, Future

import numpy as np
import pytest
from hasel_common.progress import Stage, Workload
from hasel_recording import Recording
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run, Simulation
from hasel_sysid.experiment import Experiment
from hasel_sysid.noise import NoiseModel
from hasel_sysid.problem import Problem
from hasel_sysid.testing.made_up_world import MadeUpWorld, simulated_runs

RUN = Run("let go", np.linspace(0.0, 1.0, 20), None)
NAMES = ("first", "second")


class Lost(Executor):
    """Simulates nothing: angles that are finite, and derivatives by the second parameter that are not."""

    def submit(self, function, /, *arguments, **keywords):
        """A finished batch of one run."""
        slopes = np.column_stack([RUN.time, np.full(20, np.nan)])
        nothing = np.zeros((20, 0))
        future: Future = Future()
        future.set_result([Simulation(RUN, np.sin(RUN.time), NAMES, slopes, nothing, nothing)])
        return future


def test_derivatives_that_are_not_finite_are_an_error_of_that_model_alone():
    """It is told by the parameter's name, and a search goes on with other models."""
    problem = Problem([Experiment(Recording("let go", RUN.time, RUN.time), RUN)], Lost())
    (found,) = problem.evaluate_each([load_model("beam")], [NAMES])
    assert isinstance(found, SimulationError)
    with pytest.raises(SimulationError, match="let go: the derivatives by second are not finite"):
        problem.evaluate(load_model("beam"), NAMES)


def test_some_of_its_runs_are_judged_by_the_noise_of_all():
    """And by how far they swing themselves; what was counted of all of them is not theirs."""
    world = MadeUpWorld(1)
    whole = world.measured(world.with_typical("payload"))
    whole.evaluate(world.model)
    swing = whole.largest_swing
    one = whole.with_experiments(whole.experiments[2:3])
    assert (whole.evaluations, one.evaluations) == (1, 0)
    series = one.experiments[0].sin_theta
    assert one.largest_swing == np.abs(series - series.mean()).max() < swing
    alone, every = one.evaluate(world.model), whole.evaluate(world.model)
    np.testing.assert_array_equal(alone.residual, every.residual[every.runs == 2])
    known = Problem(whole.experiments, Lost(), NoiseModel(0.002, 0.0, 0.5))
    assert known.with_experiments(known.experiments[:1]).measured_noise == known.measured_noise


def test_a_simulation_is_counted_as_soon_as_it_has_ended():
    """In one process too, before the others of all runs have; one with derivatives is more work."""
    swimmer = load_model("swimmer").with_levels(np.array([5500.0]))
    problem = simulated_runs(swimmer, [(5500.0, 2.0)] * 20, np.arange(12) / 120)
    seen = []

    class Watched(SerialExecutor):
        def submit(self, function, /, *arguments, **keywords):
            seen.append(problem.workload.now().done)
            return super().submit(function, *arguments, **keywords)

    problem.pool, problem.workload = Watched(), Workload([Stage("fit", 1e6)])
    problem.evaluate(swimmer)
    assert seen[0] == 0 < seen[1] < 20
    assert problem.workload.now().done == 20
    without = problem.workload.now().share
    problem.evaluate(swimmer, swimmer.free)
    assert problem.workload.now().share > 2.5 * without
