"""The noise has the strength and memory asked for."""

import numpy as np
import pytest
from hasel_bringup.virtual_rig.camera_noise import CameraNoise


@pytest.mark.parametrize(
    ("white", "coloured", "correlation"), [(0.002, 0.0, 0.9), (0.0, 0.003, 0.9), (0.002, 0.003, 0.8)]
)
def test_strength_and_memory(white, coloured, correlation):
    """Variance is the sum of both parts', covariance of neighbours that of the coloured part."""
    noise = CameraNoise(white, coloured, correlation, seed=3)
    series = np.array([noise.next() for _ in range(200_000)])
    assert series.var() == pytest.approx(white**2 + coloured**2, rel=0.03)
    assert np.mean(series[1:] * series[:-1]) == pytest.approx(correlation * coloured**2, rel=0.04, abs=3e-8)


def test_the_seed_decides():
    """The same seed repeats the noise, another does not."""
    first, same, other = (CameraNoise(1.0, 1.0, 0.5, seed) for seed in (1, 1, 2))
    values = [noise.next() for noise in (first, same, other)]
    assert values[0] == values[1] != values[2]
