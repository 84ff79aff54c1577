"""False alarms under white and correlated noise, of the threshold used and of the usual one."""

import numpy as np
import pytest
from hasel_sysid.diagnosis.significance import largest_drops_by_noise, orthonormal, p_value
from hasel_sysid.noise import NoiseModel, estimate_noise
from scipy.stats import chi2

RUNS = np.repeat(np.arange(3), 240)
TIME = np.tile(np.arange(240) / 120.0, 3)
FITTED = np.column_stack([np.sin(2 * np.pi * TIME), np.cos(2 * np.pi * TIME)])
CANDIDATES = [np.sin(2 * np.pi * TIME * k / 3 + p)[:, None] for k in range(1, 7) for p in (0.0, 1.0)]


def _largest_drop(residual):
    basis = orthonormal(FITTED)
    drops = []
    for columns in CANDIDATES:
        direction = orthonormal(columns - basis @ (basis.T @ columns))
        drops.append(float(((direction.T @ residual) ** 2).sum()))
    return max(drops)


@pytest.mark.parametrize(
    "noise", [NoiseModel(9e-6, 0.0, 0.5), NoiseModel(1e-7, 9e-6, 0.9)], ids=["white", "AR(1)"]
)
def test_false_alarms_stay_below_five_percent(noise):
    """With the noise estimated from each data set itself, something is accused in at most 5 % of 40 of them."""
    basis = orthonormal(FITTED)
    alarms = 0
    for residual in noise.sample(RUNS, 40, np.random.default_rng(5)).T:
        left = residual - basis @ (basis.T @ residual)
        found = estimate_noise(left, RUNS, FITTED, "a test")
        by_noise = largest_drops_by_noise(FITTED, CANDIDATES, found, RUNS)
        alarms += p_value(_largest_drop(left), by_noise) < 0.01
    assert alarms <= 2


def test_usual_threshold_fails_under_correlated_noise():
    """A chi-square test on frames, Bonferroni included, accuses somebody nearly every time."""
    noise = NoiseModel(1e-7, 9e-6, 0.9)
    limit = chi2.ppf(1 - 0.05 / len(CANDIDATES), 1)
    draws = noise.sample(RUNS, 50, np.random.default_rng(6)).T
    assert np.mean([_largest_drop(r) / np.var(r) > limit for r in draws]) > 0.7


def test_a_real_effect_is_seen():
    """An effect of half the noise's size per frame has a small p-value."""
    noise = NoiseModel(1e-7, 9e-6, 0.9)
    residual = noise.sample(RUNS, 1, np.random.default_rng(7))[:, 0] + 0.004 * CANDIDATES[-1][:, 0]
    by_noise = largest_drops_by_noise(FITTED, CANDIDATES, noise, RUNS)
    assert p_value(_largest_drop(residual), by_noise) < 0.01
