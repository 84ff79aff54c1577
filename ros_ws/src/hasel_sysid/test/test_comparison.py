# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Comparisons of a model with recordings."""

from pathlib import Path

import numpy as np
import pytest
from hasel_common.progress import Workload
from hasel_recording import Recording, read_recording
from hasel_sim.model import load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Simulation
from hasel_sysid.command_line.shown import condition_table, run_table
from hasel_sysid.comparison import Comparison, compare, comparison_of, with_amplitudes
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import experiment_of
from rich.console import Console


def _simulation(one, sin_theta: np.ndarray) -> Simulation:
    frames = len(sin_theta)
    return Simulation(
        one.run, sin_theta, (), np.zeros((frames, 0)), np.zeros((frames, 3, 2)), np.zeros((frames, 2))
    )


@pytest.fixture
def compared(made_recording, angle) -> Comparison:
    """Two runs, the second one unseen, of a model that bends 10 % too little and sits 0.02 too low."""
    experiments = [
        experiment_of(made_recording(voltage=4500.0, name="a")),
        experiment_of(made_recording(voltage=5500.0, name="b", seed=1)),
    ]
    simulations = [_simulation(e, 0.9 * angle(e.run.time, 2.0) - 0.02) for e in experiments]
    return comparison_of(load_model("swimmer"), experiments[:1], simulations, experiments[1:], "model")


def test_errors_with_and_without_offset(compared, angle):
    """The offset is taken out of the error, and left in the raw one; unseen runs are counted apart."""
    run = compared.runs[0]
    moved = 0.1 * angle(run.series.time, 2.0)
    assert run.mean_absolute_error == pytest.approx(np.abs(moved - moved.mean()).mean(), rel=0.05)
    assert run.mean_absolute_error_raw == pytest.approx(np.abs(moved + 0.02).mean(), rel=0.05)
    assert compared.mean_absolute_error == run.mean_absolute_error
    assert compared.mean_absolute_error_unseen == compared.runs[1].mean_absolute_error
    assert [r.unseen for r in compared.runs] == [False, True]


def test_fit_percent_is_that_of_the_field(compared):
    """100 (1 - |r| / |y - mean|): 10 % too little motion is a fit of 90 %, as with other toolboxes."""
    assert compared.runs[0].fit_percent == pytest.approx(90.0, abs=1.5)


def test_json_holds_what_is_printed(compared):
    """The machine-readable form has errors by run, voltage and frequency, and the sentences."""
    content = compared.to_json()
    assert content["mae_fit"] == compared.mean_absolute_error
    assert content["mae_validation"] == compared.mean_absolute_error_unseen
    assert [row["level"] for row in content["by_level"]] == [4500, 5500]
    assert [row["label"] for row in content["by_level"]] == ["4500 V", "5500 V"]
    assert content["by_frequency"][0]["frequency"] == 2.0
    assert content["where_it_fails"] == compared.where.sentences()
    assert any("more than the model" in sentence for sentence in content["where_it_fails"])


def test_tables_show_every_run_and_model(compared):
    """One model: error, offset, fit; two models: their errors side by side."""
    console = Console(record=True, width=120)
    console.print(run_table([compared]), condition_table([compared]))
    text = console.export_text()
    assert f"{compared.runs[0].mean_absolute_error:.5f}" in text
    assert "b (unseen)" in text
    console.print(run_table([compared, Comparison("other", *_but_label(compared))]))
    assert "other" in console.export_text()


def _but_label(comparison: Comparison) -> tuple:
    return comparison.model, comparison.runs, comparison.where, comparison.set_up


def test_set_up_faults_are_found_first(made_recording, angle):
    """A flipped angle is reported as a fault of the set-up by the comparison."""
    recording = made_recording()
    flipped = Recording("flipped", recording.time_s, -recording.sin_theta, recording.voltage)
    one = experiment_of(flipped)
    compared = comparison_of(load_model("swimmer"), [one], [_simulation(one, angle(one.run.time, 2.0))])
    assert "sign flip or swapped channels" in [finding.fault for finding in compared.set_up]


def test_amplitudes_are_kept_or_started(made_recording):
    """A fitted model keeps its voltages for unseen ones; one without gets a start value for each."""
    one = experiment_of(made_recording(voltage=4250.0))
    fitted = load_model("swimmer").with_levels(np.array([3500.0, 5500.0]))
    assert with_amplitudes(fitted, [one]).levels.tolist() == [3500.0, 5500.0]
    assert with_amplitudes(load_model("swimmer"), [one]).levels.tolist() == [4250.0]


def test_beam_cannot_be_driven(made_recording):
    """A body without muscles against driven recordings is one sentence."""
    with pytest.raises(SysidError, match="has no muscles"):
        compare(load_model("beam"), [experiment_of(made_recording())], SerialExecutor())


def test_nothing_to_compare():
    """No recording at all is one sentence."""
    with pytest.raises(SysidError, match="no recording"):
        compare(load_model("swimmer"), [], SerialExecutor())


def test_right_model_leaves_only_noise_on_unseen_data(unseen_rig: Path):
    """With the rig's values, a run of the independent simulator is matched to 0.004, and nothing stands out."""
    values = {"amplitude_3500": 0.0268, "amplitude_4500": 0.0440, "amplitude_5500": 0.0624, "slope": 0.264}
    model = load_model("swimmer").with_levels(np.array([3500.0, 4500.0, 5500.0])).with_values(values)
    paths = [unseen_rig / "nothing_hidden" / name for name in ("fit_5500V_3.5Hz.csv", "val_4800V_2.5Hz.csv")]
    fitted, unseen = (experiment_of(read_recording(path)) for path in paths)
    work = Workload()
    compared = compare(model, [fitted], SerialExecutor(), [unseen], workload=work)
    assert compared.mean_absolute_error < 0.004
    assert compared.mean_absolute_error_unseen < 0.004
    assert compared.set_up == ()
    assert compared.where.failures == ()
    assert work.now().done == 2
    lagging = compare(model.with_values({"slope": 0.12}), [fitted], SerialExecutor(), [unseen])
    assert lagging.mean_absolute_error > 3 * compared.mean_absolute_error
    assert lagging.where.sentences() != compared.where.sentences()
