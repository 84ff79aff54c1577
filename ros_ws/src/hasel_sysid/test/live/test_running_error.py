"""The running error ends where `compare` ends."""

import numpy as np
import pytest
from hasel_sysid.live.pairing import Pair
from hasel_sysid.live.running_error import RunningErrors

_FRAME = 10_000_000


def test_the_offset_of_the_run_is_taken_out():
    """Mean magnitude of the differences less their mean, over the frames so far."""
    generator = np.random.default_rng(1)
    measured, simulated = generator.normal(size=(2, 3000))
    errors = RunningErrors(reset=2.0)
    for n, pair in enumerate(zip(measured, simulated + 5.0, strict=True)):
        error = errors.add(Pair(0, n * _FRAME, *pair))
        if n in (1, 1500, 2999):
            difference = (simulated + 5.0 - measured)[: n + 1]
            expected = np.abs(difference - difference.mean()).mean()
            assert error.mean_absolute == pytest.approx(expected, rel=1e-12)
            assert (error.count, error.difference) == (n + 1, difference[-1])


@pytest.mark.parametrize("second", [Pair(1, 0, 0.0, 3.0), Pair(0, 300 * _FRAME, 0.0, 3.0)])
def test_another_run_begins_anew(second):
    """After a restart or a long gap nothing of the old run is left."""
    errors = RunningErrors(reset=2.0)
    errors.add(Pair(0, 0, 0.0, 1.0))
    assert errors.add(Pair(0, _FRAME, 0.0, 2.0)).count == 2
    error = errors.add(second)
    assert (error.count, error.mean_absolute) == (1, 0.0)
