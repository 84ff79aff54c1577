import numpy as np
import pytest
from hasel_benchmark.bench_hidden.noise import NOISE_RMS, draw_noise


@pytest.mark.parametrize(("colour", "correlation"), [("white", 0.0), ("coloured", 0.9)])
def test_has_the_stated_size_and_correlation(colour, correlation):
    """Standard deviation 0.003 whatever the colour, from the first frame on; lag-one correlation as stated."""
    generator = np.random.default_rng(0)
    long = draw_noise(200_000, colour, generator)
    first = np.array([draw_noise(2, colour, generator)[0] for _ in range(2000)])
    assert long.std() == pytest.approx(NOISE_RMS, rel=0.03)
    assert first.std() == pytest.approx(NOISE_RMS, rel=0.06)
    assert np.corrcoef(long[1:], long[:-1])[0, 1] == pytest.approx(correlation, abs=0.01)
