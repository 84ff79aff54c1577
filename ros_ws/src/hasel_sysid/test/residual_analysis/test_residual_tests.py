# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Whiteness, dependence on the drive, phase profile and noise of a residual."""

import warnings

import numpy as np
import pytest
from hasel_sysid.residual_analysis.residual_tests import drive_dependence, phase_profile, whiteness
from hasel_sysid.residual_analysis.robust_statistics import high_frequency_noise
from hasel_sysid.residual_analysis.run_series import RunSeries


def test_white_noise_is_called_white_at_the_stated_rate():
    """Of 300 white residuals whose variance changes, about 1 % are rejected at 1 %."""
    rng = np.random.default_rng(1)
    swell = 1 + np.sin(np.linspace(0, 6, 240)) ** 2
    white = [whiteness(swell * rng.normal(size=240), 1 / 120).is_white for _ in range(300)]
    assert 0.95 <= np.mean(white) <= 1.0


def test_correlated_noise_is_not_white():
    """Noise with correlation 0.8 from frame to frame is not white and stays alike for some frames."""
    rng = np.random.default_rng(2)
    series = np.zeros(480)
    for n in range(1, 480):
        series[n] = 0.8 * series[n - 1] + rng.normal()
    found = whiteness(series, 1 / 120)
    assert not found.is_white
    assert found.autocorrelation[0] == pytest.approx(0.8, abs=0.1)
    assert found.correlation_time == pytest.approx(9 / 120, rel=0.6)
    assert "not white" in str(found)


def test_residual_that_follows_the_command_depends_on_it(made_run):
    """A residual that is a delayed copy of the command leaves the band; noise does not, in most of 40 runs."""
    delayed = made_run(
        lambda time, simulated, truth: simulated + 0.01 * np.sign(np.sin(2 * np.pi * 2 * time - 0.5))
    )
    assert drive_dependence(delayed).depends
    quiet = [drive_dependence(made_run(seed=seed)).depends for seed in range(40)]
    assert sum(quiet) <= 3


def test_phase_profile_shows_where_in_the_cycle(made_run):
    """A difference in the first tenth after the second switch is worst there, and repeats every cycle."""

    def change(time, simulated, truth):
        phase = np.mod(2 * time, 1.0)
        return simulated + 0.02 * ((phase >= 0.5) & (phase < 0.6))

    profile = phase_profile(made_run(change))
    assert 0.5 <= profile.phase[np.nanargmax(profile.absolute)] <= 0.6
    assert profile.repeats > 0.8
    assert abs(phase_profile(made_run()).repeats) < 0.4


def test_noise_under_motion(made_run):
    """The noise is found within 15 % whatever moves under it."""
    series = made_run(noise=0.003, frequency=0.5, periods=2).measured
    assert high_frequency_noise(series) == pytest.approx(0.003, rel=0.15)


TIME = np.arange(361) / 120.0
SWITCHES = np.arange(0.0, 3.0, 0.25)
BOXES = np.array([[5000.0, 0.0], [0.0, 5000.0]])[np.arange(len(SWITCHES)) % 2]
MOVED = 0.2 * np.sin(4 * np.pi * TIME)


def _profile(measured: np.ndarray):
    return phase_profile(RunSeries("run", TIME, measured, MOVED, SWITCHES, BOXES))


def test_what_the_drive_causes_repeats_and_noise_does_not():
    """A third harmonic comes back in every cycle of 0.5 s; white noise does not."""
    found = _profile(MOVED + 0.01 * np.sin(12 * np.pi * TIME))
    assert found.repeats == pytest.approx(1.0, abs=1e-3)
    assert found.mean == pytest.approx(0.01 * np.sin(6 * np.pi * found.phase), abs=2e-3)
    noisy = _profile(MOVED + 0.01 * np.random.default_rng(1).standard_normal(len(TIME)))
    assert abs(noisy.repeats) < 0.2


def test_a_perfect_model_leaves_nothing_that_could_repeat():
    """No correlation of a residual that does not change, and no warning of a division by nothing."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = _profile(MOVED)
    assert np.isnan(found.repeats) and np.all(found.absolute == 0.0)
