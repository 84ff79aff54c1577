# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A beam let go in a truth of another mesh, time step and damping of the numerics: stress of the start is named."""

import numpy as np
import pytest
from hasel_benchmark.bench_far import FarCase, baseline, measure, observed, swings
from hasel_bringup.hidden_truth.truth import NUMERICS
from hasel_sysid.improvement import improve
from hasel_sysid.problem import Problem

CANDIDATES = ("initial_relaxation", "viscoelastic_creep", "slow_creep", "gravity_tilt", "linear_drag")
NOISE = 3e-4


@pytest.mark.parametrize("share", [0.06, -0.06], ids=["bent just before", "bent further before"])
def test_stress_of_the_start_is_named_with_its_size(share, pool):
    """Not taken for a creep that starts relaxed, nor for a tilt; its interval holds the truth."""
    values = {"initial_relaxation.share": share, "initial_relaxation.relaxation_time": 0.7}
    truth = NUMERICS["near"].applied(baseline("beam")).with_effects("initial_relaxation").with_values(values)
    *fitted, unseen = observed(truth, swings(), NOISE, np.random.default_rng(5), pool)
    found = improve(Problem(fitted, pool), baseline("beam"), Problem([unseen], pool), CANDIDATES).to_json()
    assert found["verdict"]["missing"] == ["initial_relaxation"]
    assert found["verdict"]["status"] == "explained"
    for name, value in values.items():
        entry = found["stages"][-1]["parameters"][name]
        assert abs(entry["value"] - value) < 2.5 * entry["std"]
    assert found["stages"][-1]["mae_validation"] < 1.1 * NOISE * np.sqrt(2 / np.pi)


def test_a_load_of_any_size_is_named_before_a_number_of_the_model_file(pool):
    """A density somebody measured does nearly what a load does of twenty times the typical one."""
    fitted, unseen = measure(FarCase("payload", -0.1, "beam", 2e-5), 0.2057, pool)
    found = improve(Problem(fitted, pool), baseline("beam"), Problem(unseen, pool)).to_json()
    assert found["verdict"]["missing"] == ["payload"]
    assert found["stages"][-1]["parameters"]["payload.mass"]["value"] == pytest.approx(0.2057, rel=0.02)
