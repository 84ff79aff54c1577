# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A lag behind muscles of which nobody knows where they begin to contract."""

import numpy as np
import pytest
from hasel_bringup.hidden_truth.plan import BoxRun
from hasel_bringup.hidden_truth.truth import NOMINAL, NUMERICS, truth_model
from hasel_recording import Recording
from hasel_sim.model import load_model
from hasel_sim.parallel import simulate_all
from hasel_sysid.dataset import prepared
from hasel_sysid.estimation import identify
from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Problem

NOISE = 0.003
HIDDEN = {
    "charging_lag": {"charge_time": 0.1, "discharge_time": 0.1},
    "current_limit": {"inverse_rate": 4e-5},
    "drive_hysteresis": {"width": 1000.0},
}
"""Each passes every voltage, or stays below the onset that three amplitudes of a saturating muscle would suggest."""


@pytest.mark.slow
@pytest.mark.parametrize("effect", HIDDEN)
def test_what_sweeps_the_drive_is_found_to_the_noise(effect, pool):
    """In a truth of another mesh, step and muscle law; the intervals hold what is hidden, or are open.

    A play leaves four contractions to be known by three amplitudes, its width and the onset: its width is open.
    """
    truth = truth_model(NUMERICS["near"], NOMINAL, {effect: HIDDEN[effect]})
    runs = [BoxRun(voltage, f).run() for voltage in (3500.0, 4500.0, 5500.0) for f in (0.5, 3.5)]
    generator = np.random.default_rng(5)
    experiments = []
    for run, found in zip(runs, simulate_all(pool, truth, runs), strict=True):
        series = found.sin_theta + NOISE * generator.standard_normal(len(run.time))
        drive = {"drive_time_s": run.schedule.time, "drive_values": run.schedule.signal}
        signal = run.schedule.at(run.time)
        experiments.append(
            Experiment(Recording(run.name, run.time, series, drive_signal=signal, **drive), run)
        )
    problem = Problem(experiments, pool)
    baseline = identify(problem, prepared(load_model("swimmer"), experiments), "least_squares").model
    fit = identify(problem, baseline.with_effects(effect), "least_squares")
    assert np.sqrt(np.mean(fit.evaluation.residual**2)) < 1.05 * NOISE
    for name, hidden in HIDDEN[effect].items():
        p = fit.model.parameters[f"{effect}.{name}"]
        if p.name in fit.undetermined:
            assert effect == "drive_hysteresis"
        else:
            assert abs(p.value - hidden) < 2.5 * p.standard_error < 0.2 * hidden, str(p)
