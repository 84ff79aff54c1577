# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is said about many runs together."""

import warnings

import numpy as np
import pytest
from hasel_sysid.comparison import error_by_frequency, error_by_level
from hasel_sysid.residual_analysis.analysis import where_it_fails
from hasel_sysid.residual_analysis.component import Kind
from hasel_sysid.residual_analysis.robust_statistics import pool, standing_out
from hasel_sysid.residual_analysis.run_series import RunSeries

CONDITIONS = [(voltage, frequency) for voltage in (3500.0, 5500.0) for frequency in (0.5, 2.0, 3.5)]


def _runs(made_run, change):
    return [
        made_run(change(f, v), frequency=f, voltage=v, seed=n, name=f"{v:.0f}V_{f}Hz")
        for n, (v, f) in enumerate(CONDITIONS)
    ]


def test_common_lag_that_grows_with_frequency(made_run):
    """A lag in all runs, larger at 3.5 Hz, gives one sentence with both."""

    def change(frequency, voltage):
        lag = 0.035 if frequency == 3.5 else 0.010
        return lambda time, simulated, truth: truth(time - lag)

    found = where_it_fails(_runs(made_run, change))
    assert found.failures[0].component.kind is Kind.LAG
    sentence = found.sentences()[0]
    assert sentence.startswith("all runs: lags")
    assert "more at 3.5 Hz" in sentence
    assert "more at 5500 V" not in sentence


def test_offset_that_follows_the_drive(made_run):
    """An offset that grows with the voltage is told apart from one of the camera."""
    found = where_it_fails(_runs(made_run, lambda f, v: lambda time, s, truth: s + 0.02 * (v > 4000) + 0.002))
    offset = next(f for f in found.failures if f.component.kind is Kind.OFFSET)
    assert "not alike in all runs" in str(offset)
    assert "more at 5500 V" in str(offset)


def test_opposite_signs_are_named_with_both_runs(made_run):
    """A gain too high in half of the runs and too low in the others is not averaged away."""

    def change(frequency, voltage):
        return lambda time, simulated, truth: simulated * (1.2 if voltage > 4000 else 0.8)

    gain = next(f for f in where_it_fails(_runs(made_run, change)).failures if f.component.kind is Kind.GAIN)
    assert gain.where != "all runs"
    assert "20 % more" in str(gain)
    assert "20 % less" in str(gain)


def test_nothing_stands_out_of_noise(made_run):
    """Runs that differ by noise alone get one reassuring sentence."""
    found = where_it_fails(_runs(made_run, lambda f, v: lambda time, simulated, truth: simulated))
    assert found.sentences() == ["No systematic difference stands out from the noise."]


def test_worst_part_of_the_cycle(made_run):
    """An error right after the lower muscle's switch is located there."""

    def change(frequency, voltage):
        def bump(time, simulated, truth):
            phase = np.mod(frequency * time, 1.0)
            return simulated + 0.03 * ((phase >= 0.55) & (phase < 0.65))

        return bump

    text = str(where_it_fails(_runs(made_run, change)))
    assert "of a cycle after the lower muscle is switched on" in text


def test_errors_by_condition(made_run):
    """The tables hold the mean absolute error of the runs of each condition."""
    runs = _runs(made_run, lambda f, v: lambda time, s, truth: s * (1.5 if v > 4000 else 1.0))
    low, high = error_by_level(runs)
    assert (low.condition, high.condition, low.runs) == (3500, 5500, 3)
    assert high.mean_absolute_error > 5 * low.mean_absolute_error
    assert low.mean_absolute_error == pytest.approx(0.002 * np.sqrt(2 / np.pi), rel=0.15)
    assert [row.condition for row in error_by_frequency(runs)] == [0.5, 2.0, 3.5]


def test_pooled_mean_and_scatter():
    """Equal values pool to themselves with a smaller error; spread ones show their scatter."""
    alike = pool([1.0, 1.0, 1.0, 1.0], [0.1] * 4)
    assert (alike.mean, alike.standard_error, alike.scatter) == pytest.approx((1.0, 0.05, 0.0))
    assert pool([0.0, 2.0, 0.0, 2.0], [0.1] * 4).scatter == pytest.approx(1.15, rel=0.02)


def test_trend_needs_a_clear_difference():
    """A condition stands out only beyond its errors."""
    assert standing_out([1, 1, 2, 2], [1.0, 1.1, 3.0, 3.1], [0.1] * 4) == 2
    assert standing_out([1, 1, 2, 2], [1.0, 1.1, 1.2, 1.3], [0.3] * 4) is None


def test_a_phase_without_any_frame_is_no_warning_and_no_worst_one(made_run):
    """At 30 frames/s and 2 Hz a cycle has fifteen frames, which leave every fourth of twenty parts empty."""
    run = made_run(lambda time, s, truth: s + 0.02 * np.sin(12 * np.pi * time))
    every = slice(None, None, 4)
    seldom = RunSeries(
        run.name, run.time[every], run.measured[every], run.simulated[every], run.drive_time, run.drive_values
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = where_it_fails([seldom])
    assert 0 < np.isfinite(found.profile).sum() < len(found.profile)
