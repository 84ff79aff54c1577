"""Whiteness, dependence on the drive, phase profile and noise of a residual."""

import numpy as np
import pytest
from hasel_sysid.where_it_fails.drive_dependence import drive_dependence
from hasel_sysid.where_it_fails.noise import high_frequency_noise
from hasel_sysid.where_it_fails.phase_profile import phase_profile
from hasel_sysid.where_it_fails.whiteness import whiteness


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
    assert 0.5 <= profile.worst_phase <= 0.6
    assert profile.repeats > 0.8
    assert abs(phase_profile(made_run()).repeats) < 0.4


def test_noise_under_motion(made_run):
    """The noise is found within 15 % whatever moves under it."""
    series = made_run(noise=0.003, frequency=0.5, periods=2).measured
    assert high_frequency_noise(series) == pytest.approx(0.003, rel=0.15)
