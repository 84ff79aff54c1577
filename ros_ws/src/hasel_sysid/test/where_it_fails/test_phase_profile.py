"""The residual by phase of the drive's cycle."""

import warnings

import numpy as np
import pytest
from hasel_sysid.where_it_fails.phase_profile import phase_profile
from hasel_sysid.where_it_fails.run_series import RunSeries

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
