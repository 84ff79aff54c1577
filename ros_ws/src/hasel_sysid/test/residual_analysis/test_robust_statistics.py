# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Robust least squares against an independent library."""

import numpy as np
import pytest
from hasel_sysid.residual_analysis.robust_statistics import regress
from statsmodels.regression.linear_model import OLS


@pytest.mark.parametrize(("count", "frame_time"), [(60, 1 / 120), (400, 1 / 120), (400, 0.0), (30, 0.01)])
def test_standard_errors_are_those_of_newey_and_west(count, frame_time):
    """Coefficients, covariance and residual are statsmodels' for correlated noise of changing size."""
    random = np.random.default_rng(count)
    columns = np.column_stack([np.ones(count), np.sin(np.arange(count) / 9), random.normal(size=count)])
    noise = np.convolve(random.normal(size=count), np.ones(5), "same") * (1 + np.arange(count) / count)
    series = columns @ [0.3, -2.0, 0.1] + noise
    ours = regress(series, columns, frame_time)
    lags = int(np.clip(round(0.1 / frame_time) if frame_time else 1, 1, count // 4))
    theirs = OLS(series, columns).fit(cov_type="HAC", cov_kwds={"maxlags": lags, "use_correction": True})
    np.testing.assert_allclose(ours.coefficients, theirs.params, rtol=1e-9)
    np.testing.assert_allclose(ours.covariance, theirs.cov_params(), rtol=1e-8, atol=1e-14)
    np.testing.assert_allclose(ours.residual, theirs.resid, atol=1e-12)
