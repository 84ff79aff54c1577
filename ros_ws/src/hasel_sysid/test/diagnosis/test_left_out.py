"""Cross-validation by runs against refitting explicitly."""

from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sysid.diagnosis.left_out import left_out_squares


def test_equals_refits_without_each_run():
    """For a linear model it is the error of every run under a fit to the others."""
    generator = np.random.default_rng(0)
    runs = np.repeat(np.arange(3), 50)
    jacobian = generator.normal(size=(150, 2))
    data = jacobian @ [1.0, -2.0] + 0.1 * generator.normal(size=150)
    fitted = np.linalg.lstsq(jacobian, data, rcond=None)[0]
    evaluation = SimpleNamespace(runs=runs, jacobian=jacobian, residual=data - jacobian @ fitted)
    expected = 0.0
    for run in range(3):
        others = np.linalg.lstsq(jacobian[runs != run], data[runs != run], rcond=None)[0]
        expected += np.sum((data[runs == run] - jacobian[runs == run] @ others) ** 2)
    assert left_out_squares(evaluation, runs).sum() == pytest.approx(expected, rel=1e-9)


def test_what_only_one_run_tells_stays_as_it_is_without_it():
    """The last run alone moves the second parameter but for a trace, from which nothing far away follows."""
    generator = np.random.default_rng(1)
    runs = np.repeat(np.arange(3), 50)
    jacobian = generator.normal(size=(150, 2))
    jacobian[runs < 2, 1] *= 0.02
    residual = 0.1 * generator.normal(size=150)
    residual -= jacobian @ np.linalg.lstsq(jacobian, residual, rcond=None)[0]
    evaluation = SimpleNamespace(runs=runs, jacobian=jacobian, residual=residual)
    assert left_out_squares(evaluation, runs).sum() == pytest.approx(residual @ residual, rel=0.1)
    others = np.linalg.lstsq(jacobian[runs < 2], residual[runs < 2], rcond=None)[0]
    assert np.sum((residual - jacobian @ others)[runs == 2] ** 2) > 2 * np.sum(residual[runs == 2] ** 2)
