"""Steps of a trial."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sysid.diagnosis.trial import Trial, _shortened


def test_half_a_step_promises_three_quarters_of_a_whole_one():
    """So it is for least squares, linear or not far from it: an effect that overshot once is not lost from sight."""
    jacobian, residual = np.array([[1.0], [1.0]]), np.array([3.0, 1.0])
    (whole,), *_ = np.linalg.lstsq(jacobian, residual, rcond=None)
    left = residual - jacobian[:, 0] * whole
    trial = Trial(
        start=None,
        model=SimpleNamespace(values={"rate": 0.5}),
        names=("rate",),
        residual=residual,
        jacobian=jacobian,
        step={"rate": 0.5 + whole},
        predicted=float(left @ left),
    )
    half = _shortened(trial)
    after = residual - jacobian[:, 0] * 0.5 * whole
    assert half.step == {"rate": pytest.approx(0.5 + 0.5 * whole)}
    assert half.predicted == pytest.approx(after @ after)
