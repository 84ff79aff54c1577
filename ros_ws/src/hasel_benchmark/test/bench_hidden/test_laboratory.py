# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_benchmark.bench_hidden.hidden_cases import Case
from hasel_benchmark.bench_hidden.laboratory import NOISE_RMS, draw_noise, measure
from hasel_bringup.hidden_truth.plan import BoxRun
from hasel_sim.parallel import SerialExecutor
from hasel_sysid.dataset import load_experiments

FITTED, UNSEEN = [BoxRun(5500.0, 3.5)], [BoxRun(5200.0, 3.5, unseen=True)]
DRAG = Case("single", ("quadratic_drag",), 1.0, 3, "white", "near")
NOTHING = Case("nothing", (), 0.0, 3, "white", "near")


def laboratory(case, **keywords):
    """Two short runs of a case."""
    return measure(case, SerialExecutor(), fitted=FITTED, unseen=UNSEEN, **keywords)


@pytest.fixture(scope="module")
def drag():
    """Two short runs with drag hidden."""
    return laboratory(DRAG)


def test_a_case_is_the_same_each_time_and_differs_by_seed(drag):
    """Seeded: to the last digit the same data for the same case, others for another seed."""
    again = laboratory(DRAG)
    other = laboratory(Case("single", ("quadratic_drag",), 1.0, 4, "white", "near"))
    np.testing.assert_array_equal(again.fitted[0].sin_theta, drag.fitted[0].sin_theta)
    assert again.values == drag.values
    assert np.abs(other.fitted[0].sin_theta - drag.fitted[0].sin_theta).max() > 0.003


def test_hidden_drag_changes_what_is_measured(drag):
    """The hidden effect is really in the data: by more than the noise and the drawn muscles' offsets."""
    rms = [np.std(e.sin_theta) for e in (drag.fitted[0], laboratory(NOTHING).fitted[0])]
    assert rms[0] < rms[1] - 0.003
    assert 0 < drag.values["quadratic_drag"]["coefficient"] <= 0.33


def test_floor_is_the_mean_of_the_noise_alone(drag):
    """Mean |noise| of normal noise of 0.003 rms is 0.0024."""
    assert drag.floor_fitted == pytest.approx(0.0024, rel=0.25)
    assert drag.floor_unseen == pytest.approx(0.0024, rel=0.25)


def test_csv_files_hold_a_truth_that_switches_on_frames(tmp_path):
    """Written and read back, each run has the same frames, angles and switching instants."""
    made = laboratory(DRAG, switch_on_frames=True)
    made.write(tmp_path)
    back = load_experiments([tmp_path / "fit_5500V_3.5Hz.csv", tmp_path / "val_5200V_3.5Hz.csv"])
    for one, two in zip((*made.fitted, *made.unseen), back, strict=True):
        np.testing.assert_array_equal(one.sin_theta, two.sin_theta)
        np.testing.assert_array_equal(one.run.schedule.switches(), two.run.schedule.switches())


def test_measured_drive_switches_at_true_instants(drag):
    """In memory the recording keeps the exact switches, which no frame coincides with."""
    time, _ = drag.fitted[0].recording.drive()
    np.testing.assert_allclose(time, np.arange(5) / 7.0)


@pytest.mark.parametrize(("colour", "correlation"), [("white", 0.0), ("coloured", 0.9)])
def test_has_the_stated_size_and_correlation(colour, correlation):
    """Standard deviation 0.003 whatever the colour, from the first frame on; lag-one correlation as stated."""
    generator = np.random.default_rng(0)
    long = draw_noise(200_000, colour, generator)
    first = np.array([draw_noise(2, colour, generator)[0] for _ in range(2000)])
    assert long.std() == pytest.approx(NOISE_RMS, rel=0.03)
    assert first.std() == pytest.approx(NOISE_RMS, rel=0.06)
    assert np.corrcoef(long[1:], long[:-1])[0, 1] == pytest.approx(correlation, abs=0.01)
