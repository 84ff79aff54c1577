"""A beam let go in a truth of another mesh, time step and damping of the numerics: stress of the start is named."""

import numpy as np
import pytest
from hasel_benchmark.bench_far.far_case import baseline
from hasel_bringup.hidden_truth.truth import NUMERICS
from hasel_recording import Recording
from hasel_sim.parallel import simulate_all
from hasel_sim.run import Run
from hasel_sysid.dataset import Experiment
from hasel_sysid.improvement import improve
from hasel_sysid.problem import Problem

CANDIDATES = ("initial_relaxation", "viscoelastic_creep", "slow_creep", "gravity_tilt", "linear_drag")
NOISE = 3e-4


def let_go(truth, pool):
    """Two runs that are fitted and one that is not, with noise and an offset of each."""
    time, generator = np.arange(0.0, 2.5, 0.01), np.random.default_rng(5)
    runs = [Run(f"from {f:g}", time, None, "static_equilibrium", f) for f in (1.3, 1.6, 1.45)]
    found = []
    for run, simulation in zip(runs, simulate_all(pool, truth, runs), strict=True):
        noise = NOISE * generator.standard_normal(len(time)) + 0.01 * generator.standard_normal()
        found.append(Experiment(Recording(run.name, time, simulation.sin_theta + noise, None), run))
    return found[:2], found[2:]


@pytest.mark.parametrize("share", [0.06, -0.06], ids=["bent just before", "bent further before"])
def test_stress_of_the_start_is_named_with_its_size(share, pool):
    """Not taken for a creep that starts relaxed, nor for a tilt; its interval holds the truth."""
    values = {"initial_relaxation.share": share, "initial_relaxation.relaxation_time": 0.7}
    truth = NUMERICS["near"].applied(baseline("beam")).with_effects("initial_relaxation").with_values(values)
    fitted, unseen = let_go(truth, pool)
    found = improve(Problem(fitted, pool), baseline("beam"), Problem(unseen, pool), CANDIDATES).to_json()
    assert found["verdict"]["missing"] == ["initial_relaxation"]
    assert found["verdict"]["status"] == "explained"
    for name, value in values.items():
        entry = found["stages"][-1]["parameters"][name]
        assert abs(entry["value"] - value) < 2.5 * entry["std"]
    assert found["stages"][-1]["mae_validation"] < 1.1 * NOISE * np.sqrt(2 / np.pi)
