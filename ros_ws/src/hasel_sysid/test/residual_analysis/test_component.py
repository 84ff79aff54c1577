# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Words for a difference, without numbers that nobody can believe."""

import numpy as np
import pytest
from hasel_sysid.residual_analysis.component import Component, Kind, words
from hasel_sysid.residual_analysis.residual_tests import DriveDependence


@pytest.mark.parametrize(
    ("kind", "value", "said"),
    [
        (Kind.GAIN, 0.42, "moves 42 % more than the model"),
        (Kind.GAIN, 503.18, "moves many times more than the model, which hardly moves"),
        (Kind.GAIN, -503.18, "moves against the model"),
        (Kind.UPPER_AGAINST_LOWER, 80.0, "bends many times more to the lower than to the upper side"),
        (Kind.GAIN_DRIFT, -70.0, "fades many times over within a second against the model"),
    ],
)
def test_a_percentage_is_given_where_the_model_is_a_scale(kind, value, said):
    """Not 50318 % less."""
    assert words(Component(kind, value, 0.1, "1", 0.1)) == said


def test_a_correlation_is_not_within_more_than_one():
    """Where the band is as wide as all there is, nothing can be told."""
    found = DriveDependence(np.zeros(1), np.zeros(1), 1.01)
    assert "1.01" not in str(found)
    assert "cannot be told" in str(found)
