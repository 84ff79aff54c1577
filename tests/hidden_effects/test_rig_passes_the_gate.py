# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Clean recordings with missing physics: the data gate must not take an effect for a fault of the set-up."""

from pathlib import Path

import pytest
from hasel_sim.bench.cases import fitted_swimmer
from hasel_sim.parallel import simulate_all
from hasel_sysid.data_quality import Severity, check_against_model, check_recording
from hasel_sysid.dataset import load_experiments, prepared

RIG = Path(__file__).resolve().parents[2] / "data" / "unseen_rig"


@pytest.mark.parametrize("case", sorted(path.name for path in RIG.iterdir() if path.is_dir()))
def test_no_run_is_refused(case, pool):
    """All twelve runs of a case pass without an error, alone and beside the model that lacks the effect."""
    experiments = load_experiments(sorted((RIG / case).glob("*.csv")))
    assert len(experiments) == 12
    known = fitted_swimmer()
    fitted = {name: known.values[name] for name in known.free}
    model = prepared(known, experiments).with_values(fitted)
    simulations = simulate_all(pool, model, [experiment.run for experiment in experiments])
    for experiment, simulation in zip(experiments, simulations, strict=True):
        recording = experiment.recording
        found = check_recording(recording) + check_against_model(recording, simulation.sin_theta)
        assert [str(f) for f in found if f.severity is Severity.ERROR] == []
